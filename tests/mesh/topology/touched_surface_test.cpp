// SPDX-License-Identifier: Apache-2.0
// Which balls touch a surface, against the distances from all triangles.
#include "topology/touched_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "portable_math.h"
#include "topology/triangle_distance.h"

namespace relief::detail {
namespace {

TEST(TouchedSurface, IsThatOfTheNearestTriangle) {
    Random random(7);
    const auto point = [&](double size) {
        return glm::dvec3(random.between(-size, size), random.between(-size, size),
                          random.between(-size, size));
    };
    for (const std::size_t count : {0, 1, 300}) {
        CollapseInput input;
        for (std::uint32_t i = 0; i < count; ++i) {
            const glm::dvec3 place = point(1.0);
            for (int corner = 0; corner < 3; ++corner)
                input.positions.emplace_back(place + point(0.1));
            // Each tenth triangle has no area.
            input.topology.triangles.emplace_back(3 * i, 3 * i + 1,
                                                  i % 10 == 0 ? 3 * i : 3 * i + 2);
        }
        std::vector<Ball> balls;
        for (int i = 0; i < 500; ++i)
            balls.push_back({point(1.2), i % 5 == 0 ? 1e-6 : random.between(0.0, 0.2)});
        const std::vector<bool> touch = touch_surface(balls, input);
        ASSERT_EQ(touch.size(), balls.size());
        for (std::size_t i = 0; i < balls.size(); ++i) {
            double nearest = std::numeric_limits<double>::infinity();
            for (const glm::uvec3& t : input.topology.triangles) {
                nearest = std::min(
                    nearest, squared_distance(balls[i].center, {input.point(t.x), input.point(t.y),
                                                                input.point(t.z)}));
            }
            EXPECT_EQ(touch[i], nearest <= balls[i].radius * balls[i].radius) << count << " " << i;
        }
        if (count == 300) {
            const auto touched = std::count(touch.begin(), touch.end(), true);
            EXPECT_GT(touched, 50);
            EXPECT_LT(touched, 400);
        }
    }
    EXPECT_TRUE(touch_surface({}, CollapseInput()).empty());
}

}  // namespace
}  // namespace relief::detail
