// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which reading explains a map, in words, and what to do about it.
/// Tests: tests/tools/relief_bake_verify_test.cpp.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "relief/mesh/map_convention.h"

namespace relief::tools {

/// "green is turned round (down instead of up, or the reverse): read so, it is 0.12 degrees off
/// instead of 23.4"
std::string convention_words(const ConventionFit& fit);

/// For JSON: "axes", "space", ... of what differs.
std::vector<std::string> convention_parts(const ConventionFit& fit);

/// Commands that make a map as it should be, where there are such, or a model that fits it. Files
/// to write are called "out.png" and "out.glb".
std::vector<std::string> convention_remedies(const std::filesystem::path& map,
                                             const std::filesystem::path& low,
                                             const ConventionFit& fit);

}  // namespace relief::tools
