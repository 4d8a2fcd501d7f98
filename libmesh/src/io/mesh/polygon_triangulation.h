// SPDX-License-Identifier: Apache-2.0
/// \file
/// Cutting polygons into triangles by one fixed rule.
///
/// A quad is cut along the diagonal that is shorter in texture space, or, where there are no
/// texture coordinates or the two are equal, shorter in object space, and on a further tie from its
/// first corner to its third: MikkTSpace's rule, so that tangents agree with those of the quad
/// mesh. A quad with one reflex corner is cut there instead, since the other diagonal lies outside.
/// Larger polygons are cut into ears in the plane of their Newell normal, the lowest corner number
/// first, so that a convex one becomes a fan around its first corner.
///
/// Source: [Mikkelsen 2008] (quads), [Sutherland et al. 1974] (Newell's normal), [Meisters 1975]
/// (ears). Tests: tests/mesh/io/mesh/polygon_triangulation_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace relief {

/// Cuts a polygon of n corners into n - 2 triangles with its own winding.
///
/// \param positions  one per corner, object space, any unit of length; at least 3
/// \param texcoords  one per corner, or empty
/// \param triangles  gets triples of corner numbers appended
/// \return false where no ear cut fits (no plane, crossing edges, non-finite corners, or more than
///         a billion point tests needed): what was left then is cut as a fan
bool triangulate_polygon(std::span<const glm::vec3> positions, std::span<const glm::vec2> texcoords,
                         std::vector<glm::uvec3>& triangles);

}  // namespace relief
