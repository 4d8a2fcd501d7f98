// SPDX-License-Identifier: Apache-2.0
/// \file
/// The parts of a dense mesh that a bake keeps apart. Tests: tests/make/part_matching_test.cpp.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "relief/make/asset.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"

namespace relief::make::detail {

/// Joins parts of equal names, and parts with a vertex at the same position: rays at the border
/// between them must hit both. The names are joined, too: "base + hinge".
/// \param mesh  valid
/// \return the parts in the order of their first names; none without names
NamedParts separate_parts(const Mesh& mesh, const NamedParts& parts);

/// Returns the parts of a mesh whose vertices are copies of those of another one.
/// \param part_of  by triangle of `before`, whose parts share no vertex
std::vector<std::uint32_t> parts_of_copy(const Mesh& before, std::span<const std::uint32_t> part_of,
                                         const FramedMesh& after);

/// Returns a range for each run of triangles of one part, whose number is the material.
std::vector<MaterialRange> ranges_of(std::span<const std::uint32_t> part_of);

/// The inverse of ranges_of().
std::vector<std::uint32_t> parts_of_ranges(const Mesh& mesh);

/// Meshes of parts, and the triangles that see them.
struct BakedParts {
    std::vector<Mesh> meshes;
    std::vector<BakePart> parts;  ///< They refer to `meshes`.
};

/// Divides a dense mesh.
/// \param high_parts  of the dense mesh
/// \param low_parts  of the triangles of the asset, with the same numbers
BakedParts divided(const Mesh& high, const NamedParts& high_parts,
                   std::span<const std::uint32_t> low_parts);

}  // namespace relief::make::detail
