// SPDX-License-Identifier: Apache-2.0
/// \file
/// Names of files in commands that reports show. Tests: tests/tools/relief_bake_check_test.cpp.
#pragma once

#include <filesystem>
#include <string>

namespace relief::tools {

/// A file's name as it is typed in a shell.
std::string quoted(const std::filesystem::path& file);

}  // namespace relief::tools
