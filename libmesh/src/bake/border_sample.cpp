// SPDX-License-Identifier: Apache-2.0
// The distance from an edge is the weight of the corner opposite of it, times that corner's height.
// Tests: tests/mesh/bake/border_sample_test.cpp.
#include "bake/border_sample.h"

#include <cmath>

namespace relief {
namespace {

double sum(const glm::dvec3& v) {
    return v.x + v.y + v.z;
}

/// One over the height of each corner above the edge opposite of it.
glm::dvec3 inverse_heights(const Mesh& mesh, const glm::uvec3& corners) {
    const glm::dvec3 a(mesh.positions[corners.x]);
    const glm::dvec3 b(mesh.positions[corners.y]);
    const glm::dvec3 c(mesh.positions[corners.z]);
    const double twice_area = glm::length(glm::cross(b - a, c - a));
    return glm::dvec3(glm::distance(b, c), glm::distance(c, a), glm::distance(a, b)) / twice_area;
}

}  // namespace

std::optional<CoveredTexel> moved_inside(const Mesh& mesh, const CoveredTexel& texel,
                                         double distance) {
    const glm::dvec3 weights(texel.weights());
    glm::dvec3 least = distance * inverse_heights(mesh, mesh.triangles[texel.triangle]);
    if (!std::isfinite(sum(least))) return std::nullopt;
    if (glm::all(glm::greaterThanEqual(weights, least))) return std::nullopt;
    glm::dvec3 moved;
    if (sum(least) >= 1.0) {
        moved = least / sum(least);  // Edges' lengths are to each other as these.
    } else {
        const glm::dvec3 excess = glm::max(weights - least, glm::dvec3(0.0));
        moved = least + excess * ((1.0 - sum(least)) / sum(excess));
    }
    CoveredTexel result = texel;
    result.second = static_cast<float>(moved.y);
    result.third = static_cast<float>(moved.z);
    return result;
}

}  // namespace relief
