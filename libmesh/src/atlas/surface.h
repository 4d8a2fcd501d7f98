// SPDX-License-Identifier: Apache-2.0
/// \file
/// The surface that an atlas is made for: triangles joined across edges, in an order that depends
/// on positions only.
///
/// Vertices with equal positions are one. They are sorted along a Morton curve; each triangle
/// begins with its smallest vertex (its orientation is kept), and triangles are sorted by their
/// vertices. All sums run in this order and all ties go to the smaller index, so that the atlas is
/// the same for any order of triangles, of vertices and of the corners of a triangle.
///
/// Two triangles are neighbors if they run along an edge in opposite directions, and if no other
/// triangle does. Where more triangles meet, pairs in opposite directions are joined, the flattest
/// one first; all others are cut apart.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "geometry/corners.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief::detail {

inline constexpr std::uint32_t no_face = std::numeric_limits<std::uint32_t>::max();

/// Corner c of a face is 3 * face + i. The edge c runs from corner c to the next corner.
struct AtlasSurface {
    /// Shifted and scaled to a box whose largest side is 1.
    std::vector<glm::dvec3> positions;
    double unit = 1.0;  ///< The length in object space of 1 here.
    std::vector<glm::uvec3> faces;
    std::vector<double> areas;
    /// For each edge, the edge of its neighbor; or no_corner.
    std::vector<Corner> opposite;
    /// True for edges where charts may not continue, although the faces are joined.
    std::vector<bool> is_border;

    /// For each triangle of the mesh, its face; no_face if it is degenerate or not finite. Equal
    /// triangles have one face.
    std::vector<std::uint32_t> face_of_triangle;
    /// For each triangle of the mesh, the corner that is the first one of its face.
    std::vector<std::uint8_t> first_corner;

    [[nodiscard]] const glm::dvec3& position(Corner corner) const {
        return positions[faces[corner / 3][static_cast<glm::length_t>(corner % 3)]];
    }
    /// Returns the vector along the normal of a triangle whose length is twice its area.
    [[nodiscard]] glm::dvec3 doubled_area(const glm::uvec3& face) const {
        return glm::cross(positions[face.y] - positions[face.x],
                          positions[face.z] - positions[face.x]);
    }
    /// Returns the unit normal of a face.
    [[nodiscard]] glm::dvec3 normal(std::uint32_t face) const {
        const glm::dvec3 across = doubled_area(faces[face]);
        return across / std::sqrt(glm::dot(across, across));
    }
    [[nodiscard]] double edge_length(Corner corner) const {
        return glm::length(position(next_in_triangle(corner)) - position(corner));
    }
};

/// Angles between face normals up to this one, in radians, are due to rounding.
inline constexpr double flat_angle = 1e-5;

/// The borders of charts that the caller asks for.
struct AtlasConstraints {
    bool at_materials = false;
    bool at_seams = false;  ///< Where the texture coordinates of the mesh differ.
    /// Radians between face normals: edges with a larger angle are hard, but none up to flat_angle.
    std::optional<double> hard_angle = std::nullopt;
    /// The first vertex of each part (UnwrapOptions::first_vertices).
    std::span<const std::uint32_t> first_vertices{};
    /// For each triangle of the mesh, or empty: edges between densities whose ratio is above 2.
    std::span<const float> densities{};
};

/// \param mesh  valid (mesh.h)
/// \param report  counts triangles without area, non-finite and repeated ones, and edges where
///         triangles are cut apart
AtlasSurface atlas_surface(const Mesh& mesh, const AtlasConstraints& constraints, Report& report);

/// \throws InvalidInput if the first vertices of parts do not ascend from 0
void check_parts(const Mesh& mesh, std::span<const std::uint32_t> first_vertices);

}  // namespace relief::detail
