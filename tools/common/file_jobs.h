// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which files a command line names, and the file that each is to become.
///
/// Two files without -o are IN and OUT. With -o every file is an input, and -o a file for the one
/// or a folder for all: a folder is what exists as one or ends in '/'. A name with "<UDIM>" in it
/// stands for all tiles that exist, 1001 and on. Nothing is guessed beyond that: what could be read
/// in two ways is refused. Tests: tests/tools/file_jobs_test.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace relief::tools {

/// What stands for the number of a tile in a name.
inline constexpr std::string_view tile_word = "<UDIM>";

/// A path by which the same file has the same name, whether it exists or not.
std::filesystem::path identity_of(const std::filesystem::path& file);

/// A file's name with something else in place of a word, if the word is in it; folders stay.
std::filesystem::path with_word(const std::filesystem::path& file, std::string_view word,
                                const std::string& replacement);

/// Whether a file's name has a word in it; folders do not count.
bool names_word(const std::filesystem::path& file, std::string_view word);

/// The command line's words on files.
struct FileWords {
    std::vector<std::filesystem::path> files;
    std::optional<std::string> output;  ///< -o, as typed: a '/' at its end counts.
};

struct Job {
    std::filesystem::path input;
    std::filesystem::path output;
};

struct JobList {
    std::vector<Job> jobs;
    /// Where -o names a folder, which need not exist yet.
    std::optional<std::filesystem::path> folder;
    /// Whether one job is all that the words could have meant.
    [[nodiscard]] bool is_single() const { return jobs.size() == 1 && !folder && !has_tiles; }
    bool has_tiles = false;
};

/// \param kind            what the files are, for messages: "model"
/// \param name_in_folder  the name that what becomes of an input has in the output folder; throws
///                        UsageError where the input is of no use
/// \throws UsageError if inputs and output cannot be told apart, if two inputs would become the
///         same file, or if one name of a pair has "<UDIM>" in it and the other has not;
///         FileError if no tile of a name exists
JobList jobs_of(
    const FileWords& words, const std::string& kind,
    const std::function<std::filesystem::path(const std::filesystem::path&)>& name_in_folder);

}  // namespace relief::tools
