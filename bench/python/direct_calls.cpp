// SPDX-License-Identifier: Apache-2.0
// Calls of the library without Python, for overhead.py, which loads them by ctypes.
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "relief/mesh/buffers.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/tangents.h"

using relief::StridedSpan;

extern "C" {

[[gnu::visibility("default")]] void direct_vertex_normals(const glm::vec3* positions,
                                                          std::size_t vertices,
                                                          const std::uint32_t* indices,
                                                          std::size_t triangles,
                                                          glm::vec3* normals) {
    relief::vertex_normals(StridedSpan(positions, vertices),
                           relief::TriangleSpan(std::span(indices, 3 * triangles)),
                           relief::NormalOptions{}, StridedSpan(normals, vertices));
}

[[gnu::visibility("default")]] void direct_vertex_tangents(
    const glm::vec3* positions, const glm::vec3* normals, const glm::vec2* texcoords,
    std::size_t vertices, const std::uint32_t* indices, std::size_t triangles,
    glm::vec4* tangents) {
    relief::vertex_tangents(StridedSpan(positions, vertices), StridedSpan(normals, vertices),
                            StridedSpan(texcoords, vertices),
                            relief::TriangleSpan(std::span(indices, 3 * triangles)),
                            StridedSpan(tangents, vertices));
}

}  // extern "C"
