// SPDX-License-Identifier: Apache-2.0
// Errors of maps with answers that are known.
#include "map_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "relief/mesh/error.h"

namespace relief {
namespace {

/// A map of 4 x 4 texels that lean so many degrees to the right.
Image leaning_map(double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0;
    Image map = make_image(4, 4, 3, 32, ColorSpace::data);
    for (std::size_t i = 0; i < 16; ++i) {
        map.as<float>()[3 * i] = static_cast<float>(std::sin(angle));
        map.as<float>()[3 * i + 2] = static_cast<float>(std::cos(angle));
    }
    return map;
}

const std::vector<glm::dvec3> level(16, glm::dvec3(0.0, 0.0, 1.0));

TEST(MapErrors, AreTheLeanOfEachTexel) {
    Image map = leaning_map(1.0);
    map.as<float>()[0] = map.as<float>()[2];  // 45 degrees in the upper left corner.
    const Image angles = angles_of(map, level);
    EXPECT_EQ(angles.channels, 1);
    EXPECT_NEAR(static_cast<double>(angles.as<float>()[0]), 45.0, 1e-5);
    EXPECT_NEAR(static_cast<double>(angles.as<float>()[5]), 1.0, 1e-5);
    EXPECT_NEAR(map_errors(map, level).max, 45.0, 1e-5);
    EXPECT_NEAR(map_errors(map, level).mean, (45.0 + 15.0) / 16.0, 1e-5);
    EXPECT_NEAR(map_errors(map, level, 1).max, 1.0, 1e-5);
    EXPECT_EQ(map_errors(map, level, 1).count, 4U);
}

TEST(MapErrors, CountWhatHasNoDirectionAndRefuseOtherSizes) {
    Image map = leaning_map(1.0);
    map.as<float>()[2] = 0.0F;
    map.as<float>()[0] = 0.0F;
    EXPECT_EQ(map_errors(map, level).undefined, 1U);
    EXPECT_EQ(map_errors(map, level).count, 15U);
    EXPECT_THROW(map_errors(make_image(4, 5, 3, 32, ColorSpace::data), level), InvalidInput);
    EXPECT_THROW(map_errors(make_image(4, 4, 3, 16, ColorSpace::data), level), InvalidInput);
}

}  // namespace
}  // namespace relief
