// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which triangles are neighbours across which edge, found and stored corner by corner.
///
/// Two triangles are neighbours when they run along an edge in opposite directions. At an edge with
/// more than two triangles, each has at most one neighbour, chosen by a fixed rule (see
/// corner_links.cpp) that looks at vertices and textures, never at the order of triangles. Time is
/// linear but for sorting the edges of each vertex.
/// Tests: tests/mesh/geometry/corner_links_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/corners.h"
#include "geometry/texture_gradient.h"

namespace relief {

struct CornerLinks {
    /// For a corner at vertex V whose triangle goes on from V to W: the corner at V of the
    /// neighbour across the edge VW; no_corner where there is none.
    std::vector<Corner> across;
    /// For a triangle with the same corners in the same order around as another, the one among them
    /// that counts; for any other triangle its own index. Only that one has neighbours.
    std::vector<std::uint32_t> twin;

    /// The corner at the same vertex across the edge on which the triangle arrives at it; the
    /// inverse of `across`.
    [[nodiscard]] Corner across_previous(Corner corner) const {
        const Corner beyond = across[previous_in_triangle(corner)];
        return beyond == no_corner ? no_corner : previous_in_triangle(beyond);
    }
};

/// \param triangles  over welded vertices
/// \param corners    of those triangles that take part
CornerLinks link_corners(std::span<const glm::uvec3> triangles, const CornersByVertex& corners,
                         std::span<const Gradient> kinds);

}  // namespace relief
