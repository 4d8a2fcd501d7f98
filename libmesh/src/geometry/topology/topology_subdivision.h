// SPDX-License-Identifier: Apache-2.0
/// \file
/// Where one level of Loop's subdivision puts the vertices of a surface.
/// Tests: tests/mesh/geometry/topology/subdivide_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/topology/topology.h"

namespace relief {

struct LoopPoints {
    std::vector<glm::dvec3> at_vertices;  ///< By vertex of the topology.
    std::vector<glm::dvec3> on_edges;     ///< By corner: of the edge to the next corner.
};

/// \param points  by vertex of the topology
LoopPoints loop_points(const Topology& topology, std::span<const glm::dvec3> points);

}  // namespace relief
