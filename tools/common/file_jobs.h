// SPDX-License-Identifier: Apache-2.0
/// \file
/// The input and output files of a command line, and the same job on several files.
///
/// Two files without -o are IN and OUT. With -o all files are inputs, and the output is a file for
/// one input or a folder for all. A folder exists or ends in '/'. A name with "<UDIM>" stands for
/// all existing tiles from 1001. Ambiguous command lines are errors.
///
/// Jobs run in parallel. An error in one file does not stop the others.
/// Tests: tests/tools/file_jobs_test.cpp, batch_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/command.h"
#include "common/options.h"
#include "common/summary.h"
#include "relief/mesh/execution.h"

namespace relief::tools {

/// The placeholder for the number of a tile.
inline constexpr std::string_view tile_word = "<UDIM>";

/// Returns a canonical path for comparisons. The file need not exist.
std::filesystem::path identity_of(const std::filesystem::path& file);

/// \throws UsageError if a file to write is one of the other files of the command
void check_distinct(const std::string& option, const std::filesystem::path& file,
                    const std::vector<std::filesystem::path>& others);

/// Returns the names of the files of Progress::files().
std::vector<std::filesystem::path> names_of(
    const std::map<std::filesystem::path, FileStamp>& files);

/// Replaces a word in the name of a file, but not in its folders.
std::filesystem::path with_word(const std::filesystem::path& file, std::string_view word,
                                const std::string& replacement);

/// Returns whether the name of a file contains a word. Folders do not count.
bool names_word(const std::filesystem::path& file, std::string_view word);

/// Checks the name of a file to write, as the user gave it, for words in angle brackets, "<tile>",
/// which would become a part of the name.
///
/// \param known  the placeholders of the command
/// \throws UsageError if there is another one
void check_placeholders(const std::filesystem::path& file, std::span<const std::string_view> known);

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
    bool has_tiles = false;
    /// Returns whether the command line can only mean one job.
    [[nodiscard]] bool is_single() const { return jobs.size() == 1 && !folder && !has_tiles; }
};

/// \param kind            the kind of the files for messages: "model"
/// \param name_in_folder  returns the name of an output in the output folder; throws UsageError for
///                        an unusable input
/// \throws UsageError if inputs and output are ambiguous, if two inputs have the same output, or if
///         only one name of a pair contains "<UDIM>"; FileError if no tile exists
JobList jobs_of(
    const FileWords& words, const std::string& kind,
    const std::function<std::filesystem::path(const std::filesystem::path&)>& name_in_folder);

/// The result of a file.
struct FileOutcome {
    std::string line;  ///< The line for stdout, without newline.
    Findings findings;
    Summary summary;  ///< Its JSON is the entry in the report, besides "input" and "output".
};

struct Batch {
    std::vector<Job> jobs;
    /// Runs job `index`. Several threads call it.
    std::function<FileOutcome(std::size_t index)> work;
    /// Runs the jobs one after another, because two could write the same file.
    bool one_by_one = false;
    Json head;  ///< The head of the report: tool, version, options.
};

/// Runs all jobs in parallel, one per thread. Prints the line or the error of each job in the given
/// order, and then writes the report: the head, the number of failed jobs, and "files".
///
/// \return failed if a job failed; else fell_back if --strict was given and there are findings
ExitCode run_batch(const CLI::App& app, const Batch& batch, const ReportOptions& report,
                   const GeneralOptions& general);

}  // namespace relief::tools
