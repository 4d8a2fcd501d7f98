// SPDX-License-Identifier: Apache-2.0
/// \file
/// Small meshes that break naive code, and the simple meshes that they are made from.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "relief/mesh/mesh.h"
#include "support/invariants.h"

namespace relief::test {

inline constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
inline constexpr float infinite = std::numeric_limits<float>::infinity();

/// Returns the mesh with texture coordinates projected along z: u is x, v is -y. If it has no
/// normals, it gets angle-weighted ones.
Mesh textured_from_above(Mesh mesh);

/// The square from (0,0,0) to (1,1,0), facing +z, of two triangles. Vertices 0 to 3 go around it.
Mesh square();

/// The square with these normals at its vertices.
Mesh square_with_normals(const std::vector<glm::vec3>& normals);

/// cells x cells squares of edge 1 in the xy plane from the origin, facing +z.
Mesh flat_grid(int cells);

/// A flat_grid() with heights that are multiples of 1/4, so that no float near them is rounded.
Mesh wavy_grid(int cells);

/// The cube from -1 to 1 with 8 vertices. The diagonals of its faces do not match: some corners
/// have 3 triangles, some 6.
Mesh uneven_cube();

/// A closed fan of `count` triangles in the xy plane around vertex 0.
Mesh fan(unsigned count);

/// Two squares that share an edge: one is flat, and one rises at 45 degrees. Each has its own
/// vertices at the edge: 2 and 3 at x = flat_end, 4 and 5 at x = rising_begin.
Mesh ramp(float flat_end, float rising_begin);

struct NamedMesh {
    std::string name;
    Mesh mesh;
};

/// Degenerate, folded, non-manifold, huge, tiny, distant, non-finite and badly textured meshes. All
/// are valid (mesh.h) and have normals and texture coordinates.
std::vector<NamedMesh> hard_meshes();

}  // namespace relief::test
