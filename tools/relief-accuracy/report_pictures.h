// SPDX-License-Identifier: Apache-2.0
/// \file
/// The pictures of a report as files beside it. Tests: tests/tools/accuracy_report_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "accuracy_report.h"

namespace relief::tools {

/// What a picture of an experiment shows.
enum class PictureRole { heat, before, after };

/// Where a picture stands, from the report's folder: "pictures/bump-sine-heat-1.png".
std::string picture_file(const Experiment& experiment, PictureRole role, std::size_t index);

/// Writes all as PNG into folder/pictures, which is made if there are any. \throws FileError
void write_pictures(const std::filesystem::path& folder, const AccuracyReport& report);

}  // namespace relief::tools
