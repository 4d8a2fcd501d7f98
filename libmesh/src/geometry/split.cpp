// SPDX-License-Identifier: Apache-2.0
// Splits vertices by the values at their corners. The different values at a vertex are sorted: the
// smallest stays with the vertex, and each other one gets a copy. So the number and the order of
// copies do not depend on the order of triangles. The time is linear except for sorting.
#include "relief/mesh/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "geometry/check_triangles.h"
#include "geometry/corners.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"

namespace relief {
namespace {

/// Total order of floats: -0 equals +0, NaNs are ordered by their bits.
std::uint32_t ordinal(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value + 0.0F);
    return (bits & 0x80000000U) != 0 ? ~bits : bits | 0x80000000U;
}

template <int N>
bool comes_before(const glm::vec<N, float>& a, const glm::vec<N, float>& b) {
    for (int i = 0; i < N; ++i) {
        if (ordinal(a[i]) != ordinal(b[i])) return ordinal(a[i]) < ordinal(b[i]);
    }
    return false;
}

template <int N>
VertexSplit split(std::size_t vertex_count, std::span<const glm::uvec3> triangles,
                  std::span<const glm::vec<N, float>> values) {
    check_triangles(triangles, vertex_count);
    if (values.size() != 3 * triangles.size()) {
        throw InvalidInput(fmt::format("there are {} corner values, but {} corners", values.size(),
                                       3 * triangles.size()));
    }
    VertexSplit result{std::vector<std::uint32_t>(vertex_count),
                       {triangles.begin(), triangles.end()}};
    std::iota(result.source_vertex.begin(), result.source_vertex.end(), 0U);

    const CornersByVertex corners(vertex_count, triangles);
    std::vector<Corner> around;
    for (std::size_t v = 0; v < vertex_count; ++v) {
        check_cancelled(v);
        around.assign(corners.at(v).begin(), corners.at(v).end());
        std::sort(around.begin(), around.end(),
                  [&](Corner a, Corner b) { return comes_before<N>(values[a], values[b]); });
        auto vertex = static_cast<std::uint32_t>(v);
        for (std::size_t i = 1; i < around.size(); ++i) {
            if (comes_before<N>(values[around[i - 1]], values[around[i]])) {
                vertex = static_cast<std::uint32_t>(result.source_vertex.size());
                result.source_vertex.push_back(static_cast<std::uint32_t>(v));
            }
            const Corner corner = around[i];
            result.triangles[triangle_of(corner)][static_cast<int>(corner % 3)] = vertex;
        }
    }
    return result;
}

}  // namespace

VertexSplit split_where_corners_differ(std::size_t vertex_count,
                                       std::span<const glm::uvec3> triangles,
                                       std::span<const glm::vec4> corner_values) {
    return split<4>(vertex_count, triangles, corner_values);
}

VertexSplit split_where_corners_differ(std::size_t vertex_count,
                                       std::span<const glm::uvec3> triangles,
                                       std::span<const glm::vec3> corner_values) {
    return split<3>(vertex_count, triangles, corner_values);
}

Mesh carried(const Mesh& mesh, const VertexSplit& split) {
    check_cancelled();
    Mesh result;
    result.name = mesh.name;
    result.positions = carried<glm::vec3>(mesh.positions, split);
    result.normals = carried<glm::vec3>(mesh.normals, split);
    result.texcoords = carried<glm::vec2>(mesh.texcoords, split);
    result.tangents = carried<glm::vec4>(mesh.tangents, split);
    result.colors = carried<glm::vec4>(mesh.colors, split);
    result.triangles = split.triangles;
    result.material_ranges = mesh.material_ranges;
    result.smoothing_groups = mesh.smoothing_groups;
    return result;
}

}  // namespace relief
