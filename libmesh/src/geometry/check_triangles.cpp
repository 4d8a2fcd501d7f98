// SPDX-License-Identifier: Apache-2.0
// Every index against the number of vertices. First the largest, which reads as fast as memory
// gives; only where that is too large, one by one. Tests: tests/mesh/geometry/mesh_test.cpp.
#include "geometry/check_triangles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "relief/mesh/error.h"

namespace relief {

std::optional<std::size_t> corner_beyond(std::span<const glm::uvec3> triangles,
                                         std::size_t vertex_count) {
    glm::uvec3 largest(0);
    for (const glm::uvec3& triangle : triangles)
        largest = glm::max(largest, triangle);
    if (triangles.empty() || std::max({largest.x, largest.y, largest.z}) < vertex_count)
        return std::nullopt;
    for (std::size_t corner = 0;; ++corner) {
        if (triangles[corner / 3][static_cast<int>(corner % 3)] >= vertex_count) return corner;
    }
}

void check_triangles(std::span<const glm::uvec3> triangles, std::size_t vertex_count) {
    constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max() / 3;
    if (triangles.size() > most) {
        throw InvalidInput(fmt::format(
            "there are {} triangles, but no more than {} can be numbered", triangles.size(), most));
    }
    const std::optional<std::size_t> corner = corner_beyond(triangles, vertex_count);
    if (!corner) return;
    throw InvalidInput(
        fmt::format("triangle {} names vertex {}, but there are only {}", *corner / 3,
                    triangles[*corner / 3][static_cast<int>(*corner % 3)], vertex_count));
}

}  // namespace relief
