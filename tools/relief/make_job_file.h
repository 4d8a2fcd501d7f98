// SPDX-License-Identifier: Apache-2.0
/// \file
/// The file of `relief make --job`: a list of models with the options of each.
/// Tests: tests/make/make_job_file_test.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "common/file_jobs.h"
#include "make_job.h"

namespace relief::tools {

/// An asset to make.
struct MakeTask {
    Job job;
    MakeRequest request;
};

/// Adds the options of an asset to a command line.
using AddAssetOptions = std::function<void(CLI::App& app, MakeRequest& request)>;
/// Checks options together. Exceptions pass.
using CheckAssetOptions = std::function<void(const CLI::App& app, const MakeRequest& request)>;

/// Reads a job file (docs/make.md has its schema). Paths are relative to its folder.
///
/// \param add, check  of the options that assets may have, whose names are the keys of the file
/// \throws FileError with the line and the key, if the file cannot be read, if a key is unknown,
///         repeated or missing, or if a value is wrong
std::vector<MakeTask> read_job_file(const std::filesystem::path& file, const AddAssetOptions& add,
                                    const CheckAssetOptions& check);

}  // namespace relief::tools
