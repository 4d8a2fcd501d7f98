// SPDX-License-Identifier: Apache-2.0
/// \file
/// The tables of docs/bump.md, measured anew at every call: errors in degrees on fields with known
/// normals. Tests: error_tables_test.cpp.
#pragma once

#include <string>

namespace relief::test {

/// The lines of the page that the tables follow.
inline constexpr const char* kernels_begin =
    "<!-- tables of kernels: written by relief-bump-errors-page -->\n";
inline constexpr const char* choices_begin =
    "<!-- tables of choices: written by relief-bump-errors-page -->\n";
inline constexpr const char* steps_begin =
    "<!-- tables of steps: written by relief-bump-errors-page -->\n";
inline constexpr const char* depths_begin =
    "<!-- tables of depths: written by relief-bump-errors-page -->\n";

std::string kernel_tables();
std::string choice_tables();
std::string step_tables();
std::string depth_tables();

}  // namespace relief::test
