// SPDX-License-Identifier: Apache-2.0
/// \file
/// The work of `relief check`: models first, in parallel, then the images that they name or that
/// lie in the folders, each once. Tests: tests/check/relief_check_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "check_cache.h"
#include "check_item.h"
#include "check_walk.h"
#include "common/command.h"

namespace relief::tools {

/// Returns the results of single files. Several threads call it.
struct CheckSource {
    std::function<CheckedItem(const CheckInput&)> model;
    /// \param roles  as for check_image_file()
    std::function<CheckedItem(const std::filesystem::path&, const std::vector<ImageRole>&)> image;
};

/// Checks models and images. \return in the order of the walk, then images of other folders
std::vector<CheckedItem> check_all(const std::vector<CheckInput>& inputs, const CheckSource& source,
                                   Stages& stages);

/// Returns a source that reads the files, unless the cache has their results.
CheckSource reading_source(std::optional<CheckCache>& cache);

/// Calls work(index) for all indices below `count`, in parallel, as a stage.
void run_stage(Stages& stages, const std::string& name, std::size_t count,
               const std::function<void(std::size_t)>& work);

}  // namespace relief::tools
