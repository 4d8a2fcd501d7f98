// SPDX-License-Identifier: Apache-2.0
/// \file
/// From values at triangle corners to values at vertices, with as few new vertices as the corners
/// allow. Tests: tests/mesh/geometry/split_test.cpp.
#pragma once

#include <cassert>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/mesh/mesh.h"

namespace relief {

/// Which old vertex every new vertex copies, and the triangles over the new vertices.
///
/// The first old-vertex-count entries are the old vertices themselves, in their order (isolated
/// ones too); the extra copies follow. So whatever else is stored by vertex can be carried along.
struct VertexSplit {
    std::vector<std::uint32_t> source_vertex;
    std::vector<glm::uvec3> triangles;
};

/// Splits vertices until all corners that share one also share a value, as few times as that takes.
///
/// \param corner_values  three per triangle, in corner order. Values are equal if they are as
///                       numbers: -0 equals +0. NaNs are equal if their bits are.
/// \return the smallest value of a vertex stays with it, the others go to copies in ascending
/// order;
///         so the vertices do not depend on the order of triangles
/// \throws InvalidInput if a triangle names a vertex that does not exist, or the lengths disagree
VertexSplit split_where_corners_differ(std::size_t vertex_count,
                                       std::span<const glm::uvec3> triangles,
                                       std::span<const glm::vec4> corner_values);
VertexSplit split_where_corners_differ(std::size_t vertex_count,
                                       std::span<const glm::uvec3> triangles,
                                       std::span<const glm::vec3> corner_values);

/// One vertex attribute after a split; an absent (empty) one stays absent.
template <typename T>
std::vector<T> carried(std::span<const T> values, const VertexSplit& split) {
    std::vector<T> result;
    if (values.empty()) return result;
    result.reserve(split.source_vertex.size());
    for (const std::uint32_t vertex : split.source_vertex) {
        assert(vertex < values.size());
        result.push_back(values[vertex]);
    }
    return result;
}

/// A mesh after a split: every vertex attribute carried, triangles replaced, ranges kept. Any
/// choice of vertices can be carried like that, with triangles over those.
Mesh carried(const Mesh& mesh, const VertexSplit& split);

}  // namespace relief
