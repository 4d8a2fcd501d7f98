// SPDX-License-Identifier: Apache-2.0
// Light probes: where directions stand.
#include "environment/environment_images.h"

#include <gtest/gtest.h>

#include <cmath>

#include "relief/mesh/error.h"

namespace relief {
namespace {

constexpr int wide = 1 << 20;  // So wide that what the rim leaves out does not matter.

void expect_place(const glm::dvec3& direction, double u, double v) {
    const glm::dvec2 place = angular_map_place(direction, wide);
    EXPECT_NEAR(place.x, u, 1e-5);
    EXPECT_NEAR(place.y, v, 1e-5);
}

TEST(AngularMap, TheMiddleIsMinusZAndHalfwayToTheRimAreTheOtherAxes) {
    expect_place({0, 0, -3}, 0.5, 0.5);
    expect_place({1, 0, 0}, 0.75, 0.5);
    expect_place({-2, 0, 0}, 0.25, 0.5);
    expect_place({0, 1, 0}, 0.5, 0.25);
    expect_place({0, -1, 0}, 0.5, 0.75);
    // 45 degrees to the right of -z: a quarter of the way to the rim.
    expect_place({1, 0, -1}, 0.625, 0.5);
    expect_place({1, 0, 1}, 0.875, 0.5);
}

TEST(AngularMap, BehindIsTheRimOnTheSideThatTheDirectionLeansTo) {
    expect_place({1e-9, 0, 1}, 1.0, 0.5);
    expect_place({0, 1e-9, 1}, 0.5, 0.0);
    expect_place({0, 0, 1}, 1.0, 0.5);
}

TEST(AngularMap, LookupsReachNoTexelThatTheRimCuts) {
    for (const int width : {8, 32, 511, 512}) {
        for (int i = 0; i < 400; ++i) {
            const double turn = 0.0157 * i;
            const glm::dvec2 place =
                angular_map_place({1e-3 * std::cos(turn), 1e-3 * std::sin(turn), 1}, width);
            // The four texels that a bilinear lookup reads, by their outermost corner.
            const glm::dvec2 from = glm::floor(place * static_cast<double>(width) - 0.5);
            for (const glm::dvec2 corner :
                 {from, from + glm::dvec2(2, 0), from + glm::dvec2(0, 2), from + 2.0}) {
                EXPECT_LE(glm::distance(corner, glm::dvec2(0.5 * width)), 0.5 * width + 1e-9);
            }
        }
    }
}

TEST(AngularMap, AMapOfFewTexelsShowsItsMiddle) {
    EXPECT_EQ(angular_map_reach(1), 0.0);
    EXPECT_EQ(angular_map_reach(4), 0.0);
    EXPECT_EQ(angular_map_place({1, 2, 3}, 1), glm::dvec2(0.5));
    EXPECT_NEAR(angular_map_reach(512), 0.9917, 1e-4);
}

TEST(AngularMap, MustBeSquare) {
    EXPECT_NO_THROW(check_angular_map(make_image(3, 3, 3, 8, ColorSpace::srgb), "ball"));
    try {
        check_angular_map(make_image(512, 256, 3, 32, ColorSpace::linear), "ball.hdr");
        FAIL() << "was accepted";
    } catch (const InvalidInput& error) {
        EXPECT_STREQ(error.what(),
                     "angular map 'ball.hdr' has 512 x 256 texels, but must be square");
    }
    EXPECT_THROW(check_angular_map(Image{}, "nothing"), InvalidInput);
}

}  // namespace
}  // namespace relief
