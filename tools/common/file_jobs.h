// SPDX-License-Identifier: Apache-2.0
/// \file
/// The input and output files of a command line.
///
/// Two files without -o are IN and OUT. With -o all files are inputs, and the output is a file for
/// one input or a folder for all. A folder exists or ends in '/'. A name with "<UDIM>" stands for
/// all existing tiles from 1001. Ambiguous command lines are errors.
/// Tests: tests/tools/file_jobs_test.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace relief::tools {

/// The placeholder for the number of a tile.
inline constexpr std::string_view tile_word = "<UDIM>";

/// Returns a canonical path for comparisons. The file need not exist.
std::filesystem::path identity_of(const std::filesystem::path& file);

/// Replaces a word in the name of a file, but not in its folders.
std::filesystem::path with_word(const std::filesystem::path& file, std::string_view word,
                                const std::string& replacement);

/// Returns whether the name of a file contains a word. Folders do not count.
bool names_word(const std::filesystem::path& file, std::string_view word);

/// The file arguments of a command line.
struct FileWords {
    std::vector<std::filesystem::path> files;
    std::optional<std::string> output;  ///< -o as typed, because a final '/' is significant.
};

struct Job {
    std::filesystem::path input;
    std::filesystem::path output;
};

struct JobList {
    std::vector<Job> jobs;
    /// The folder of -o, which need not exist.
    std::optional<std::filesystem::path> folder;
    /// Returns whether the command line can only mean one job.
    [[nodiscard]] bool is_single() const { return jobs.size() == 1 && !folder && !has_tiles; }
    bool has_tiles = false;
};

/// \param kind            the kind of the files for messages: "model"
/// \param name_in_folder  returns the name of an output in the output folder; throws UsageError for
/// an
///                        unusable input
/// \throws UsageError if inputs and output are ambiguous, if two inputs have the same output, or if
/// only one
///         name of a pair contains "<UDIM>"; FileError if no tile exists
JobList jobs_of(
    const FileWords& words, const std::string& kind,
    const std::function<std::filesystem::path(const std::filesystem::path&)>& name_in_folder);

}  // namespace relief::tools
