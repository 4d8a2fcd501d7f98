// SPDX-License-Identifier: Apache-2.0
/// \file
/// The command whose shards parts come from. Parts of different commands do not get mixed up: their
/// merge states the difference, and names missing and repeated parts.
/// Tests: tests/tools/relief_bake_shards_test.cpp, tests/check/check_shards_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/command.h"

namespace relief::tools {

/// The facts that all parts of a command share, and parts of other commands do not.
struct PartJob {
    std::string version;                 ///< Of the program.
    std::size_t count = 0;               ///< Of shards.
    std::vector<std::string> arguments;  ///< "--size=512", without those of the process.
    std::vector<std::string> files;      ///< As given: HIGH... LOW OUT.
    std::vector<std::pair<std::string, std::string>> inputs;  ///< Names and hashes.

    friend bool operator==(const PartJob&, const PartJob&) = default;

    /// The hash of all of it.
    [[nodiscard]] std::string hash() const;
};

/// Returns the options of a command line, but for those of the process and of shards.
std::vector<std::string> shared_options(const CLI::App& app);

/// The identity of a part.
struct PartName {
    std::filesystem::path file;
    const PartJob* job = nullptr;
    std::size_t shard = 0;  ///< From 1.
};

/// Checks that the parts are all parts of one command of this version.
/// \param word  for the work of the command: "bake"
/// \return the indices of the parts by shard
/// \throws FileError that names parts of other commands, repeated and missing parts
std::vector<std::size_t> sorted_parts(std::span<const PartName> parts, const std::string& word);

}  // namespace relief::tools
