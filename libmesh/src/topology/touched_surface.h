// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which of some balls a surface touches.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "topology/triangle_distance.h"

namespace relief::detail {

struct Ball {
    glm::dvec3 center{0.0};
    double radius = 0.0;
};

/// Returns for each ball whether its distance from a triangle is at most its radius. The time is
/// proportional to the number of triangles and to the number of balls in the slab of each.
/// \param point_of returns the position of a vertex
template <typename PointOf>
std::vector<bool> touch_surface(std::span<const Ball> balls, std::span<const glm::uvec3> triangles,
                                const PointOf& point_of) {
    std::vector<bool> touched(balls.size(), false);
    if (balls.empty()) return touched;
    std::vector<std::size_t> order(balls.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return balls[a].center.x < balls[b].center.x; });
    double largest = 0.0;
    for (const Ball& ball : balls)
        largest = std::max(largest, ball.radius);
    for (const glm::uvec3& triangle : triangles) {
        const Corners corners = {point_of(triangle.x), point_of(triangle.y), point_of(triangle.z)};
        const glm::dvec3 least = glm::min(corners[0], glm::min(corners[1], corners[2]));
        const glm::dvec3 most = glm::max(corners[0], glm::max(corners[1], corners[2]));
        auto at =
            std::lower_bound(order.begin(), order.end(), least.x - largest,
                             [&](std::size_t ball, double x) { return balls[ball].center.x < x; });
        for (; at != order.end() && balls[*at].center.x <= most.x + largest; ++at) {
            const Ball& ball = balls[*at];
            const glm::dvec3 outside =
                glm::max(glm::dvec3(0.0), glm::max(least - ball.center, ball.center - most));
            const double limit = ball.radius * ball.radius;
            if (touched[*at] || glm::dot(outside, outside) > limit) continue;
            touched[*at] = squared_distance(ball.center, corners) <= limit;
        }
    }
    return touched;
}

}  // namespace relief::detail
