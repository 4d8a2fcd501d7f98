// SPDX-License-Identifier: Apache-2.0
// Balls that touch a surface: they are sorted along x, and each triangle is compared with those
// whose centers are in reach. Tests: tests/mesh/topology/touched_surface_test.cpp.
#include "topology/touched_surface.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "topology/triangle_distance.h"

namespace relief::detail {

std::vector<bool> touch_surface(std::span<const Ball> balls, const CollapseInput& input) {
    std::vector<bool> touched(balls.size(), false);
    if (balls.empty()) return touched;
    std::vector<std::size_t> order(balls.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return balls[a].center.x < balls[b].center.x; });
    double largest = 0.0;
    for (const Ball& ball : balls)
        largest = std::max(largest, ball.radius);
    for (const glm::uvec3& triangle : input.topology.triangles) {
        const Corners corners = {input.point(triangle.x), input.point(triangle.y),
                                 input.point(triangle.z)};
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
