// SPDX-License-Identifier: Apache-2.0
/// \file
/// Polygons of indexed vertices, and their triangulation by one fixed rule.
///
/// A quad is cut along the diagonal that is shorter in texture space. Without texture coordinates,
/// or if they give equal lengths, the diagonal that is shorter in object space is used; on a
/// further tie the one from the first corner to the third. This is the rule of MikkTSpace, so that
/// tangents agree with those of the quad mesh. A quad with one reflex corner is cut at this corner,
/// because the other diagonal lies outside. Larger polygons are cut into ears in the plane of their
/// Newell normal, lowest corner number first, so that a convex polygon becomes a fan around its
/// first corner.
///
/// Source: [Mikkelsen 2008] (quads), [Sutherland et al. 1974] (Newell normal), [Meisters 1975]
/// (ears).
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief {

/// Cuts a polygon of n corners into n - 2 triangles with the same winding.
///
/// \param positions  one per corner, object space, any unit of length; at least 3
/// \param texcoords  one per corner, or empty
/// \param triangles  triples of corner numbers are appended
/// \return false if ear clipping fails (no plane, crossing edges, non-finite corners, or more than
/// a billion point tests); the rest of the polygon is then cut as a fan
bool triangulate_polygon(std::span<const glm::vec3> positions, std::span<const glm::vec2> texcoords,
                         std::vector<glm::uvec3>& triangles);

/// Polygons as consecutive ranges of vertex indices.
struct Polygons {
    std::vector<std::uint32_t> corners;
    std::vector<std::uint32_t> corner_counts;
};

/// Triangles, and the polygon of each.
struct CutPolygons {
    std::vector<glm::uvec3> triangles;
    std::vector<std::uint32_t> polygons;
};

/// Triangulates polygons by triangulate_polygon().
///
/// \param vertices  positions, and texture coordinates if it has them
/// \param report    counts polygons of fewer than three corners (left out) and those without an ear
///         (cut as fans)
CutPolygons cut_polygons(const Mesh& vertices, const Polygons& polygons, Report& report);

/// Sets the triangles of a mesh. \throws FileError if a polygon names a missing vertex, or if there
/// are no triangles
void add_triangles(Mesh& mesh, const Polygons& polygons, const std::filesystem::path& file,
                   Report& report);

}  // namespace relief
