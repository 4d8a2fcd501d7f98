// SPDX-License-Identifier: Apache-2.0
/// \file
/// Remembers from what the assets of a folder were made, so that a batch makes
/// only what changed. Tests: tests/make/make_cache_test.cpp.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/text.h"

namespace relief::tools {

/// The file relief-make.json of an output folder: for each asset the options
/// with the version, and the hashes (content_hash.h) of the files that were read
/// and written.
class MakeCache {
  public:
    /// Reads the file of a folder. A file that is missing or damaged remembers
    /// nothing.
    explicit MakeCache(const std::filesystem::path& folder);

    /// Returns whether an asset was made with the same options from the same
    /// files, and all files are as they were then.
    [[nodiscard]] bool is_current(const std::filesystem::path& asset,
                                  const std::string& options) const;

    /// Returns what was remembered with an asset; null if there is nothing.
    [[nodiscard]] Json facts_of(const std::filesystem::path& asset) const;

    /// Remembers an asset.
    /// \param facts  for facts_of()
    void add(const std::filesystem::path& asset, const std::string& options,
             const std::vector<std::filesystem::path>& inputs,
             const std::vector<std::filesystem::path>& outputs, const Json& facts);

    /// Writes the file. \throws FileError
    void write() const;

  private:
    std::filesystem::path file_;
    Json assets_ = Json::object();
};

}  // namespace relief::tools
