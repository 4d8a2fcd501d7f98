// SPDX-License-Identifier: Apache-2.0
/// \file
/// Several pictures in one file, or in numbered files: --steps and --mistake.
/// Tests: tests/tools/steps_test.cpp, mistakes_test.cpp.
#pragma once

#include <filesystem>
#include <vector>

#include "relief/mesh/image.h"

namespace relief::tools {

/// Returns whether an output is numbered files: its name has a #.
bool has_numbers(const std::filesystem::path& output);

/// Joins pictures of one size and format, in rows of equal length from the top.
Image sheet_of(const std::vector<std::vector<Image>>& rows);

}  // namespace relief::tools
