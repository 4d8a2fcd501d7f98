// SPDX-License-Identifier: Apache-2.0
/// \file
/// Defines indexed triangle meshes in plain arrays, in the layout of GPU buffers.
///
/// Right-handed object space, any unit of length; triangles are counter-clockwise seen from
/// outside. Texture coordinates are those of glTF: (0,0) is the upper left corner of the stored
/// image, and v points down.
/// Tests: tests/mesh/geometry/mesh_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace relief {

/// A range of triangles with the same material.
struct MaterialRange {
    std::uint32_t first_triangle = 0;
    std::uint32_t triangle_count = 0;
    /// Index into the materials that were read with the mesh.
    std::optional<std::uint32_t> material;

    friend bool operator==(const MaterialRange&, const MaterialRange&) = default;
};

/// Triangles and vertex attributes.
///
/// Every vertex array is empty (the attribute is absent) or has the length of `positions`. Vertices
/// with equal positions but different other attributes (at a texture seam or a crease) are separate
/// entries.
struct Mesh {
    std::string name;
    std::vector<glm::vec3> positions;  ///< Object space.
    std::vector<glm::vec3> normals;    ///< Object space, unit.
    std::vector<glm::vec2> texcoords;  ///< Upper left origin, v down.
    /// Object space: xyz is unit and perpendicular to the normal, w is +1 or -1. The bitangent
    /// w * cross(normal, xyz) points towards decreasing v: up in the stored image.
    std::vector<glm::vec4> tangents;
    std::vector<glm::vec4> colors;      ///< Linear RGB and coverage, usually within [0,1].
    std::vector<glm::uvec3> triangles;  ///< Vertex indices.
    /// Disjoint and ascending ranges that cover all triangles; or empty, which means one range
    /// without a material.
    std::vector<MaterialRange> material_ranges;
    /// The smoothing groups of OBJ, one for each triangle, or empty. Edges between triangles of
    /// different groups are hard, and so are all edges of group 0. They affect the computation of
    /// normals, not stored normals.
    std::vector<std::uint32_t> smoothing_groups;
};

/// An axis-aligned box; empty (min > max) by default.
struct Bounds {
    glm::vec3 min{std::numeric_limits<float>::infinity()};
    glm::vec3 max{-std::numeric_limits<float>::infinity()};

    [[nodiscard]] bool empty() const { return !(min.x <= max.x); }
};

/// Returns the bounding box of all finite positions; empty if there is none.
Bounds bounds_of(const Mesh& mesh);

/// Checks that array lengths agree, every index names a vertex, and the material ranges are as
/// documented in `Mesh`. Values may be degenerate or non-finite.
///
/// \throws InvalidInput naming the first error: "triangle 7 names vertex 12, but there are only 8"
void validate(const Mesh& mesh);

}  // namespace relief
