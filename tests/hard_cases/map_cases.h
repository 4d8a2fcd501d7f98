// SPDX-License-Identifier: Apache-2.0
/// \file
/// Rows of the catalogue about height maps and normal maps.
#pragma once

#include <vector>

#include "hard_cases/hard_case.h"

namespace relief::test {

std::vector<HardCase> image_cases();       ///< Heights, and the normals made of them.
std::vector<HardCase> image_file_cases();  ///< Files, and what of them is no height.
std::vector<HardCase> normal_map_cases();  ///< Normals without slope, direction, z or length.
std::vector<HardCase> map_check_cases();   ///< What a map means, its heights, and who owns a texel.
std::vector<HardCase> bake_cases();        ///< Rays, and the surfaces that they meet or miss.
std::vector<HardCase> bake_shape_cases();  ///< Shapes of high and low meshes, and of maps.

}  // namespace relief::test
