// SPDX-License-Identifier: Apache-2.0
/// \file
/// Indexed triangles in plain arrays, as the GPU wants them.
///
/// Right-handed object space, any unit of length; counter-clockwise triangles face the viewer.
/// Texture coordinates are glTF's: (0,0) is the upper left corner of the stored image, v grows
/// downwards. Tests: tests/mesh/geometry/mesh_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace relief {

/// A run of triangles that share a material.
struct MaterialRange {
    std::uint32_t first_triangle = 0;
    std::uint32_t triangle_count = 0;
    std::optional<std::uint32_t> material;  ///< Index into the materials read with the mesh.

    friend bool operator==(const MaterialRange&, const MaterialRange&) = default;
};

/// Triangles and what is known at their vertices.
///
/// Every vertex array is empty (the attribute is absent) or as long as `positions`. Vertices that
/// share a position but differ elsewhere (a texture seam, a crease) are separate entries.
struct Mesh {
    std::string name;
    std::vector<glm::vec3> positions;  ///< Object space.
    std::vector<glm::vec3> normals;    ///< Object space, unit.
    std::vector<glm::vec2> texcoords;  ///< Upper left origin, v down.
    /// Object space: xyz unit and perpendicular to the normal, w = +1 or -1. The bitangent is
    /// w * cross(normal, xyz) and points to where v decreases: upwards in the stored image.
    std::vector<glm::vec4> tangents;
    std::vector<glm::vec4> colors;      ///< Linear RGB and coverage, each usually within [0,1].
    std::vector<glm::uvec3> triangles;  ///< Vertex indices.
    /// Disjoint, ascending, together all triangles; or empty: one range without a material.
    std::vector<MaterialRange> material_ranges;
    /// OBJ's, one for each triangle, or empty: edges between triangles of different groups are
    /// hard, and so are all edges of group 0. Says how normals are to be made, where they are.
    std::vector<std::uint32_t> smoothing_groups;
};

/// An axis-aligned box; empty (min > max) until something is inside.
struct Bounds {
    glm::vec3 min{std::numeric_limits<float>::infinity()};
    glm::vec3 max{-std::numeric_limits<float>::infinity()};

    [[nodiscard]] bool empty() const { return !(min.x <= max.x); }
};

/// The box of all finite positions, empty where there is none.
Bounds bounds_of(const Mesh& mesh);

/// Checks that array lengths agree, every index names a vertex, and the material ranges are as
/// `Mesh` says; values (degenerate, non-finite) are not judged.
///
/// \throws InvalidInput naming the first offence: "triangle 7 names vertex 12, but there are only
/// 8"
void validate(const Mesh& mesh);

}  // namespace relief
