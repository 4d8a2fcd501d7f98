// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which models a command line names, and the file that each is to become.
///
/// Two files without -o are IN and OUT. With -o every file is an input, and -o a file for the one
/// or a folder for all: a folder is what exists as one or ends in '/'. Nothing is guessed beyond
/// that: what could be read in two ways is refused. Tests: tests/tools/process_jobs_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "model_file.h"

namespace relief::tools {

/// The command line's words on files.
struct FileWords {
    std::vector<std::filesystem::path> files;
    std::optional<std::string> output;  ///< -o, as typed: a '/' at its end counts.
    std::optional<ModelFormat> format;  ///< Of outputs in a folder; absent: the input's own.
};

struct Job {
    std::filesystem::path input;
    std::filesystem::path output;
};

struct JobList {
    std::vector<Job> jobs;
    /// Where -o names a folder, which need not exist yet.
    std::optional<std::filesystem::path> folder;
};

/// In a folder a model keeps its name; STL and OFF, which cannot be written, become .glb unless
/// there is a `format`.
///
/// \throws UsageError if inputs and output cannot be told apart or have formats that do not serve;
///         if two models would become the same file
JobList jobs_of(const FileWords& words);

}  // namespace relief::tools
