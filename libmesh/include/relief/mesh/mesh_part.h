// SPDX-License-Identifier: Apache-2.0
/// \file
/// Extracts triangles of a mesh as a new mesh.
/// Tests: tests/mesh/geometry/mesh_test.cpp.
#pragma once

#include <cstdint>
#include <span>

#include "relief/mesh/mesh.h"

namespace relief {

/// Extracts triangles in the given order, with their smoothing groups and materials, and the
/// vertices that they use, in their order and with all attributes. The name is kept.
/// \throws InvalidInput if there is no such triangle, or the mesh is not valid
Mesh part_of(const Mesh& mesh, std::span<const std::uint32_t> triangles);

}  // namespace relief
