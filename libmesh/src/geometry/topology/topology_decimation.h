// SPDX-License-Identifier: Apache-2.0
/// \file
/// Taking vertices out of a surface, one edge at a time, cheapest first.
/// Tests: tests/mesh/geometry/topology/decimate_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "geometry/topology/topology.h"

namespace relief {

/// What to take vertices out of, and when to stop. All spans outlive the call.
struct Decimation {
    const Topology& topology;
    std::span<const glm::dvec3> points;  ///< By vertex of the topology; within [-1, 1].
    /// For each triangle of the topology the mesh vertices at its corners: where those of two
    /// neighbours differ along their edge, there is a seam.
    std::span<const glm::uvec3> wedges;
    /// For each triangle, what it may not mix with: the number of its material range.
    std::span<const std::uint32_t> parts;
    std::span<const glm::vec2> texcoords;  ///< By mesh vertex, or empty.
    std::optional<std::size_t> triangles;  ///< Stop at this many.
    std::optional<double> max_error;       ///< In the unit of the points.
};

/// For each triangle of the topology, the mesh vertices at its corners afterwards; nothing for one
/// that is gone.
std::vector<std::optional<glm::uvec3>> decimated_wedges(const Decimation& decimation);

}  // namespace relief
