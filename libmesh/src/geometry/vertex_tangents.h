// SPDX-License-Identifier: Apache-2.0
/// \file
/// MikkTSpace tangents by vertex instead of by corner, for meshes that store them so. Corner
/// tangents need 48 bytes for each triangle, which is more than all the rest of a mesh.
///
/// The mesh is worked through in slices of triangles, whose contributions fit into the cache. A
/// usual vertex (tangent_fans.h) gets its tangent from them at once; the triangles at all others
/// are left for tangents.cpp. Results are those of corner_tangents().
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/corners.h"
#include "geometry/tangent_contributions.h"
#include "relief/mesh/report.h"
#include "work_array.h"

namespace relief::detail {

/// Tangents of usual vertices, and which vertices are not usual.
struct UsualTangents {
    /// By vertex. w = 0: isolated or not usual.
    std::vector<glm::vec4> by_vertex;
    std::vector<std::uint8_t> is_unusual;  ///< By vertex.
    bool any_unusual = false;
};

/// Returns whether slices can be worked through one by one: most vertices have all their triangles
/// in one slice.
///
/// \param corners  corners of all triangles
bool has_local_triangles(const CornersByVertex& corners, std::size_t triangle_count);

/// Computes the tangents of usual vertices: MikkTSpace's weights and groups.
///
/// \param mesh  triangles with indices of welded vertices of 32 bits
/// \param corners  corners of all triangles
UsualTangents usual_tangents(const TangentInput& mesh, const CornersByVertex& corners);

/// Tangents of a mesh, by vertex where its corners agree in any case.
struct VertexTangents {
    /// By vertex. w = 0: the vertex is isolated, or its corners have the tangents. Empty: all have.
    std::vector<glm::vec4> by_vertex;
    /// The triangles whose corners have tangents, ascending. Empty if all have.
    std::vector<std::uint32_t> triangles;
    WorkArray<glm::vec4> at_corners;  ///< Three for each of these triangles, or for all.
};

/// Computes MikkTSpace tangents with the results and the findings of corner_tangents().
VertexTangents tangents_by_vertex(const TangentInput& input, Report& report);

}  // namespace relief::detail
