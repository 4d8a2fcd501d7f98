// SPDX-License-Identifier: Apache-2.0
/// \file
/// Some triangles of a mesh as a mesh of their own. Tests: tests/mesh/geometry/mesh_part_test.cpp.
#pragma once

#include <cstdint>
#include <span>

#include "relief/mesh/mesh.h"

namespace relief {

/// The vertices that the triangles use, in their order, with all their attributes; triangles in the
/// order given, with their smoothing groups and materials. The name stays.
/// \throws InvalidInput if there is no such triangle, or the mesh is not valid
Mesh part_of(const Mesh& mesh, std::span<const std::uint32_t> triangles);

}  // namespace relief
