// SPDX-License-Identifier: Apache-2.0
// Every index against the number of vertices. Tests: tests/mesh/geometry/mesh_test.cpp.
#include "geometry/check_triangles.h"

#include <fmt/format.h>

#include "relief/mesh/error.h"

namespace relief {

void check_triangles(std::span<const glm::uvec3> triangles, std::size_t vertex_count) {
    for (std::size_t triangle = 0; triangle < triangles.size(); ++triangle) {
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = triangles[triangle][corner];
            if (vertex >= vertex_count) {
                throw InvalidInput(fmt::format("triangle {} names vertex {}, but there are only {}",
                                               triangle, vertex, vertex_count));
            }
        }
    }
}

}  // namespace relief
