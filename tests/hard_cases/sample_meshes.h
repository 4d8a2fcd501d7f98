// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the rows of the catalogue are made of: positions and triangles, nothing else.
#pragma once

#include <vector>

#include "relief/mesh/mesh.h"

namespace relief::test {

Mesh mesh_of(std::vector<glm::vec3> positions, std::vector<glm::uvec3> triangles);

/// The mesh with normals averaged by angle, unless it has some, and the image laid on it from +z,
/// upright: u is x, v is -y.
Mesh textured_from_above(Mesh mesh);

/// The square from (0,0,0) to (1,1,0), facing +z: vertices 0 to 3 around, two triangles.
Mesh square();

/// cells x cells squares of edge 1 in the xy plane from the origin, facing +z.
Mesh flat_grid(int cells);

/// The same with heights that are multiples of 1/4, so that no float near them is rounded.
Mesh wavy_grid(int cells);

/// The cube from -1 to 1 with one vertex for each of its 8 corners, its faces cut along diagonals
/// that do not match: some corners have 3 triangles, some 6.
Mesh uneven_cube();

/// `count` triangles in the xy plane around vertex 0, all the way round.
Mesh fan(unsigned count);

/// Two squares that meet in an edge, one flat, one rising at 45 degrees. Each has vertices of its
/// own there: 2 and 3 at x = flat_end, 4 and 5 at x = rising_begin.
Mesh ramp(float flat_end, float rising_begin);

}  // namespace relief::test
