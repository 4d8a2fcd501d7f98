// SPDX-License-Identifier: Apache-2.0
/// \file
/// Writes meshes as the nodes of a glTF file. Tests: tests/make/stage_file_test.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/material.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {
namespace detail {

/// A primitive of a node's mesh.
struct NodePrimitive {
    Mesh mesh;  ///< Valid, with triangles; its material ranges are not used.
    std::uint32_t material = 0;
};

struct MeshNode {
    std::string name;
    std::vector<NodePrimitive> primitives;
};

struct NodeMaterial {
    std::string name;
    AlphaMode alpha_mode = AlphaMode::opaque;
};

/// Writes a node and a mesh for each item, whose positions are relative to an origin.
/// \param report  counts values that glTF forbids and that are repaired
/// \throws FileError if the file cannot be written; InvalidInput if a mesh is not valid, or names a
///         missing material
void write_nodes(const std::filesystem::path& file, std::span<const MeshNode> nodes,
                 std::span<const NodeMaterial> materials, const glm::dvec3& origin, Report& report);

}  // namespace detail
}  // namespace relief
