// SPDX-License-Identifier: Apache-2.0
/// \file
/// Converts values at triangle corners to values at vertices, with the minimum number of additional
/// vertices.
/// Tests: tests/mesh/geometry/mesh_test.cpp.
#pragma once

#include <cassert>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/mesh/mesh.h"

namespace relief {

/// The source of every new vertex, and the triangles over the new vertices.
///
/// The first entries are the old vertices in their order, including isolated ones; the copies
/// follow. Any data by vertex can be carried along with `source_vertex`.
struct VertexSplit {
    std::vector<std::uint32_t> source_vertex;
    std::vector<glm::uvec3> triangles;
};

/// Splits vertices until all corners that share a vertex also share a value, with as few copies as
/// possible.
///
/// \param corner_values  three per triangle, in corner order. They are compared as numbers: -0
///         equals +0; NaNs are equal if their bits are
/// \return the smallest value of a vertex stays with it, the others go to copies in ascending
///         order, so that the vertices do not depend on the order of triangles
/// \throws InvalidInput if a triangle names a vertex that does not exist, or the lengths differ
VertexSplit split_where_corners_differ(std::size_t vertex_count,
                                       std::span<const glm::uvec3> triangles,
                                       std::span<const glm::vec4> corner_values);
VertexSplit split_where_corners_differ(std::size_t vertex_count,
                                       std::span<const glm::uvec3> triangles,
                                       std::span<const glm::vec3> corner_values);

/// Returns a vertex attribute after a split; an absent (empty) one stays absent.
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

/// Returns a mesh after a split, with all vertex attributes, new triangles and the same ranges.
/// `split` may select any vertices.
Mesh carried(const Mesh& mesh, const VertexSplit& split);

}  // namespace relief
