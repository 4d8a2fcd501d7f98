// SPDX-License-Identifier: Apache-2.0
/// \file
/// The names of the triangles of a dense mesh in maps of ids. Tests: tests/make/asset_ids_test.cpp.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/make/asset.h"
#include "relief/mesh/bake_ids.h"
#include "relief/mesh/mesh.h"

namespace RELIEF_API relief {
namespace make::detail {

/// Returns the names of materials (names_by_material()). Triangles without a material have that of
/// their part, if there are several; with " (part)" after it if a material has the same name.
/// \param parts  of the mesh; may be none
std::vector<NamedTriangles> asset_ids(const Mesh& mesh, const NamedParts& parts,
                                      std::span<const std::string> material_names);

/// Returns the names for the meshes of divided().
/// \param keys  by triangle
std::vector<std::vector<NamedTriangles>> divided(std::span<const NamedTriangles> ids,
                                                 std::span<const std::uint32_t> keys,
                                                 std::size_t count);

}  // namespace make::detail
}  // namespace relief
