// SPDX-License-Identifier: Apache-2.0
/// \file
/// Rows of the catalogue about height maps and normal maps.
#pragma once

#include <vector>

#include "hard_cases/hard_case.h"

namespace relief::test {

std::vector<HardCase> normal_map_cases();  ///< Normals without slope, direction, z or length.

}  // namespace relief::test
