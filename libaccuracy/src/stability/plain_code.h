// SPDX-License-Identifier: Apache-2.0
/// \file
/// Normals, tangents and bump maps as they are printed in books and written in an hour: float all
/// through, nothing guarded. For contrast with relief's own, which are not made of this. Tests:
/// tests/accuracy/plain_code_test.cpp.
#pragma once

#include <vector>

#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"

namespace relief {

/// The sum of cross products around each vertex, over its length; NaN where that is 0 / 0.
std::vector<glm::vec3> plain_area_normals(const Mesh& mesh);

/// The sum of unit normals by the arc cosines of corner angles, over its length.
std::vector<glm::vec3> plain_angle_normals(const Mesh& mesh);

/// [Lengyel 2001] as printed: a tangent for each vertex, from all triangles around it. Three to a
/// triangle.
std::vector<glm::vec4> plain_tangents(const Mesh& mesh);

/// Sobel's differences of 3 x 3 heights, and (-dh/dx, -dh/dy, 1) over its length, y up; the border
/// is (0, 0, 1).
/// \param height  one float channel
Image plain_sobel_normals(const Image& height, float strength);

}  // namespace relief
