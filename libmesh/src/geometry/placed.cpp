// SPDX-License-Identifier: Apache-2.0
// Positions, normals and tangents of a mesh in another space. Source: the matrix of cofactors is
// the inverse transpose but for a factor, and defined where that is not.
// Tests: tests/mesh/geometry/placed_test.cpp.
#include "relief/mesh/placed.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace relief {
namespace {

/// The linear part in double, scaled so that tiny and huge transforms keep their digits.
glm::dmat3 directions_from(const glm::mat4& matrix) {
    glm::dmat3 linear(matrix);
    double largest = 0.0;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row)
            largest = std::max(largest, std::abs(linear[column][row]));
    }
    return largest > 0.0 ? linear / largest : glm::dmat3(1.0);
}

glm::dmat3 normals_from(const glm::dmat3& linear) {
    const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                               glm::cross(linear[0], linear[1]));
    return glm::determinant(linear) < 0.0 ? -cofactors : cofactors;
}

glm::vec3 turned(const glm::dmat3& transform, const glm::vec3& direction) {
    const glm::dvec3 result = transform * glm::dvec3(direction);
    const double length = glm::length(result);
    return length > 0.0 ? glm::vec3(result / length) : direction;
}

}  // namespace

Mesh placed(Mesh mesh, const glm::mat4& world_from_object) {
    const glm::dmat4 matrix(world_from_object);
    const glm::dmat3 tangents = directions_from(world_from_object);
    const glm::dmat3 normals = normals_from(tangents);
    const bool mirrors = glm::determinant(tangents) < 0.0;
    for (glm::vec3& position : mesh.positions)
        position = glm::vec3(matrix * glm::dvec4(position, 1.0));
    for (glm::vec3& normal : mesh.normals)
        normal = turned(normals, normal);
    for (glm::vec4& tangent : mesh.tangents) {
        tangent = glm::vec4(turned(tangents, glm::vec3(tangent)), mirrors ? -tangent.w : tangent.w);
    }
    if (mirrors) {
        for (glm::uvec3& triangle : mesh.triangles)
            std::swap(triangle.y, triangle.z);
    }
    return mesh;
}

}  // namespace relief
