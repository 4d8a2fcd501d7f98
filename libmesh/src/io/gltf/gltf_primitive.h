// SPDX-License-Identifier: Apache-2.0
/// \file
/// Primitives of a glTF document: as plain arrays, and their frames replaced.
/// Tests: tests/mesh/io/gltf/gltf_document_test.cpp.
#pragma once

#include <optional>
#include <vector>

#include "io/gltf/gltf_contents.h"
#include "relief/mesh/gltf_document.h"

namespace relief {

const Json& primitive_json(const GltfContents& contents, GltfPrimitiveId id);

/// See GltfDocument::describe.
std::string describe_primitive(const GltfContents& contents, GltfPrimitiveId id);

/// Whether other primitives have the same POSITION.
bool shares_vertices(const GltfContents& contents, const Json& primitive);

/// A primitive's triangles, over the vertices of its accessors, and which of those its mesh has.
struct GltfTriangles {
    std::vector<glm::uvec3> triangles;  ///< Over all vertices of the accessors.
    std::size_t vertex_count = 0;       ///< Of the accessors.
    /// Where a primitive shares its POSITION with others and uses only a part of it: the vertices
    /// that it uses, ascending. They are its mesh's; otherwise all are.
    std::optional<std::vector<std::uint32_t>> used;
};

/// \throws InvalidInput if indices are out of range or make no whole triangles, or attributes
/// differ
///         in number
GltfTriangles read_triangles(const GltfContents& contents, GltfPrimitiveId id);

/// See GltfDocument::mesh.
Mesh read_primitive(const GltfContents& contents, GltfPrimitiveId id, int texcoord_set);

/// See GltfDocument::set_frames.
void replace_frames(GltfContents& contents, GltfPrimitiveId id, const FramedMesh& framed);

/// See GltfDocument::set_geometry.
void replace_geometry(GltfContents& contents, GltfPrimitiveId id, const Mesh& mesh);

}  // namespace relief
