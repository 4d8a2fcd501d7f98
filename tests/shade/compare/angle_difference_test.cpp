// SPDX-License-Identifier: Apache-2.0
// Angles between pictures of directions, by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "relief/mesh/error.h"
#include "relief/shade/image_compare.h"

namespace relief {
namespace {

Image of_directions(const std::vector<glm::vec3>& directions) {
    Image image = make_image(static_cast<int>(directions.size()), 1, 3, 32, ColorSpace::data);
    for (std::size_t i = 0; i < directions.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            image.as<float>()[3 * i + c] = directions[i][static_cast<int>(c)];
    }
    return image;
}

glm::vec3 tilted(double degrees) {
    const double angle = glm::radians(degrees);
    return {std::sin(angle), 0, std::cos(angle)};
}

TEST(AngleDifference, IsInDegreesWhateverTheLengths) {
    const AngleDifference difference =
        angle_difference(of_directions({{0, 0, 1}, {0, 0, 1e-30F}, {0, 3, 0}, {1, 0, 0}}),
                         of_directions({tilted(30), {1e30F, 0, 0}, {0, 5, 0}, {-2, 0, 0}}));
    const auto map = difference.map.as<float>();
    EXPECT_NEAR(map[0], 30.0F, 1e-5F);
    EXPECT_EQ(map[1], 90.0F);
    EXPECT_EQ(map[2], 0.0F);
    EXPECT_EQ(map[3], 180.0F);
    EXPECT_NEAR(difference.mean, 75.0, 1e-5);
    EXPECT_EQ(difference.max, 180.0);
    EXPECT_EQ(difference.undefined, 0U);
}

TEST(AngleDifference, TellsTinyAnglesFromNone) {
    // The cosine of this angle is 1 in float, and in double but for its last bit.
    const AngleDifference difference =
        angle_difference(of_directions({{0, 0, 1}}), of_directions({{1e-8F, 0, 1}}));
    EXPECT_NEAR(difference.max, glm::degrees(1e-8), 1e-14);
}

TEST(AngleDifference, ThePercentileLeavesOneTexelInAHundredAbove) {
    std::vector<glm::vec3> straight(200, {0, 0, 1});
    std::vector<glm::vec3> bent;
    for (int i = 0; i < 200; ++i)
        bent.push_back(tilted(0.5 * ((i * 77) % 200)));
    const AngleDifference difference =
        angle_difference(of_directions(straight), of_directions(bent));
    // Angles 0, 0.5, ..., 99.5: 198 of the 200 do not exceed 98.5.
    EXPECT_NEAR(difference.p99, 98.5, 1e-4);
    EXPECT_NEAR(difference.max, 99.5, 1e-4);
    EXPECT_NEAR(difference.mean, 49.75, 1e-4);
}

TEST(AngleDifference, NoDirectionIsOppositeToAnyAndEqualToNone) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    const AngleDifference difference =
        angle_difference(of_directions({{0, 0, 0}, {0, nan, 1}, {0, 0, 1}, {0, 0, 1}}),
                         of_directions({{0, 0, 1}, {inf, 0, 0}, {0, 0, 0}, {0, 0, 1}}));
    const auto map = difference.map.as<float>();
    EXPECT_EQ(map[0], 180.0F);
    EXPECT_EQ(map[1], 0.0F);
    EXPECT_EQ(map[2], 180.0F);
    EXPECT_EQ(map[3], 0.0F);
    EXPECT_EQ(difference.undefined, 3U);
    EXPECT_EQ(difference.mean, 90.0);
}

TEST(AngleDifference, CodesOfANormalMapAreRefusedWithTheRemedy) {
    const Image codes = make_image(2, 2, 3, 8, ColorSpace::data);
    const Image directions = make_image(2, 2, 3, 32, ColorSpace::data);
    try {
        (void)angle_difference(directions, codes);
        FAIL() << "was accepted";
    } catch (const InvalidInput& error) {
        EXPECT_STREQ(error.what(),
                     "angles are between directions in three float channels, not 3 channels of 8 "
                     "bits; decode_normal_map reads normal maps");
    }
    EXPECT_THROW(angle_difference(directions, make_image(2, 3, 3, 32, ColorSpace::data)),
                 InvalidInput);
    EXPECT_THROW(angle_difference(Image{}, Image{}), InvalidInput);
}

}  // namespace
}  // namespace relief
