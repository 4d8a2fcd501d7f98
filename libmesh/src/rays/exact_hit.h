// SPDX-License-Identifier: Apache-2.0
/// \file
/// Whether a ray meets a triangle, decided without error. Tests:
/// tests/mesh/rays/exact_hit_test.cpp.
///
/// The corners are projected along the ray onto two coordinates, in double. The projection of a
/// corner depends on the corner and the ray alone, so all triangles at a corner agree about it. Of
/// the projected corners the test is exact: the triangle is hit if the origin of the plane lies
/// within it or on its border. Hence a ray never passes between two triangles that share an edge or
/// a vertex, and the result is the same on every processor. Source: [Woop et al. 2013].
#pragma once

#include <array>
#include <cmath>
#include <glm/glm.hpp>

namespace relief {

/// A ray, and the two axes that it is projected along.
struct RayFrame {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0};
    glm::dvec3 first{0.0}, second{0.0};
    int along = 2;  ///< The axis that the direction has its largest component along.
};

/// The direction must be finite and not zero. It may have any length.
inline RayFrame frame_of(const glm::dvec3& origin, const glm::dvec3& direction) {
    const glm::dvec3 size = glm::abs(direction);
    const int z = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    const int x = (z + 1) % 3;
    const int y = (z + 2) % 3;
    RayFrame frame{origin, direction};
    frame.along = z;
    frame.first[x] = 1.0;
    frame.first[z] = -direction[x] / direction[z];
    frame.second[y] = 1.0;
    frame.second[z] = -direction[y] / direction[z];
    // A triangle that faces the origin is then counter-clockwise in the plane.
    if (direction[z] > 0.0) std::swap(frame.first, frame.second);
    return frame;
}

struct ExactHit {
    glm::dvec3 weights{0.0};    ///< Of the corners: none negative, together 1.
    double distance = 0.0;      ///< Along the ray, in lengths of its direction.
    bool faces_origin = false;  ///< Its corners are counter-clockwise, seen from the origin.
};

/// a.x * b.y - a.y * b.x, of the right sign; 0 only if it is exactly 0.
inline double exact_cross(const glm::dvec2& a, const glm::dvec2& b) {
    const double first = a.x * b.y;
    const double second = a.y * b.x;
    if (first != second) return first - second;
    // Rounding keeps the order of different numbers, so only equal ones need their remainders.
    return std::fma(a.x, b.y, -first) - std::fma(a.y, b.x, -second);
}

/// \return whether the ray's line meets the triangle; one that is seen exactly edge-on is not met
inline bool intersect(const RayFrame& ray, const std::array<glm::dvec3, 3>& corners,
                      ExactHit& hit) {
    std::array<glm::dvec3, 3> away;
    std::array<glm::dvec2, 3> point;
    for (std::size_t i = 0; i < 3; ++i) {
        away[i] = corners[i] - ray.origin;
        const glm::dvec3& a = away[i];
        point[i] = {a.x * ray.first.x + a.y * ray.first.y + a.z * ray.first.z,
                    a.x * ray.second.x + a.y * ray.second.y + a.z * ray.second.z};
    }
    const glm::dvec3 areas(exact_cross(point[1], point[2]), exact_cross(point[2], point[0]),
                           exact_cross(point[0], point[1]));
    const bool is_left = areas.x >= 0.0 && areas.y >= 0.0 && areas.z >= 0.0;
    const bool is_right = areas.x <= 0.0 && areas.y <= 0.0 && areas.z <= 0.0;
    if (is_left == is_right) return false;  // Outside, or edge-on, or not finite.
    hit.weights = areas / (areas.x + areas.y + areas.z);
    const glm::dvec3 place =
        hit.weights.x * away[0] + hit.weights.y * away[1] + hit.weights.z * away[2];
    hit.distance = glm::dot(place, ray.direction) / glm::dot(ray.direction, ray.direction);
    hit.faces_origin = is_left;
    return true;
}

}  // namespace relief
