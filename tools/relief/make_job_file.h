// SPDX-License-Identifier: Apache-2.0
/// \file
/// The file of `relief make --job`: a list of models with the options of each.
/// Tests: tests/make/make_job_file_test.cpp.
#pragma once

#include <filesystem>
#include <vector>

#include "common/file_jobs.h"
#include "make_job.h"

namespace relief::tools {

/// An asset to make.
struct MakeTask {
    Job job;
    MakeRequest request;
};

/// Reads a job file (docs/make.md has its schema). Paths are relative to its folder.
///
/// The keys of assets are the names of make_options().
/// \throws FileError with the line and the key, if the file cannot be read, if a key is unknown,
///         repeated or missing, or if a value is wrong
std::vector<MakeTask> read_job_file(const std::filesystem::path& file);

}  // namespace relief::tools
