// SPDX-License-Identifier: Apache-2.0
/// \file
/// Rows of the catalogue about meshes: their shapes, and what is stored at their vertices.
#pragma once

#include <vector>

#include "hard_cases/hard_case.h"

namespace relief::test {

std::vector<HardCase> triangle_cases();  ///< Triangles without area, or nearly so.
std::vector<HardCase> surface_cases();   ///< How triangles meet.
std::vector<HardCase> number_cases();    ///< Scale, place, rounding, values that are none.
std::vector<HardCase> stored_cases();    ///< Normals, tangents, texture coordinates of the file.
std::vector<HardCase> tangent_cases();   ///< How the texture lies on the surface.
std::vector<HardCase> tangent_surface_cases();  ///< How the surfaces under it meet.
std::vector<HardCase> encoding_cases();         ///< Frames in few bits.

}  // namespace relief::test
