// SPDX-License-Identifier: Apache-2.0
// How far directions are from the truth: by hand, and where no answer is the only right one.
#include "relief/mesh/direction_error.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "relief/mesh/error.h"

namespace relief {
namespace {

TEST(DegreesBetween, ResolvesWhatArcCosinesCannot) {
    EXPECT_DOUBLE_EQ(degrees_between({2, 0, 0}, {0, 0, 5}), 90.0);
    EXPECT_DOUBLE_EQ(degrees_between({1, 0, 0}, {-3, 0, 0}), 180.0);
    EXPECT_EQ(degrees_between({1, 2, 3}, {2, 4, 6}), 0.0);
    EXPECT_NEAR(degrees_between({1, 0, 0}, {1, 1e-9, 0}), 57.29577951e-9, 1e-17);
}

TEST(DegreesBetween, OfNoDirectionIsNoNumber) {
    EXPECT_TRUE(std::isnan(degrees_between({0, 0, 0}, {0, 0, 1})));
    EXPECT_TRUE(
        std::isnan(degrees_between({std::numeric_limits<double>::infinity(), 0, 0}, {0, 0, 1})));
}

TEST(DirectionError, IsRmsMeanAndLargestOfThoseThatCount) {
    const std::array<glm::vec3, 3> found = {glm::vec3(0, 0, 1), {0, 1, 1}, {1, 0, 0}};
    const std::array<glm::dvec3, 3> ground_truth = {glm::dvec3(0, 0, 1), {0, 0, 1}, {0, 0, 1}};
    const DirectionError all = direction_error(found, ground_truth);
    EXPECT_EQ(all.count, 3U);
    EXPECT_DOUBLE_EQ(all.mean, 45.0);
    EXPECT_DOUBLE_EQ(all.rms, std::sqrt((45.0 * 45.0 + 90.0 * 90.0) / 3.0));
    EXPECT_DOUBLE_EQ(all.max, 90.0);
    const std::array<unsigned char, 3> counts = {1, 1, 0};
    EXPECT_DOUBLE_EQ(direction_error(found, ground_truth, counts).max, 45.0);
    EXPECT_EQ(direction_error({}, {}).count, 0U);
}

TEST(DirectionError, DoesNotHideADirectionThatIsNone) {
    const std::array<glm::vec3, 3> found = {glm::vec3(0, 0, 1), {0, 0, 0}, {1, 0, 0}};
    const std::array<glm::dvec3, 3> ground_truth = {glm::dvec3(0, 0, 1), {0, 0, 1}, {0, 0, 1}};
    const DirectionError error = direction_error(found, ground_truth);
    EXPECT_TRUE(std::isnan(error.rms));
    EXPECT_TRUE(std::isnan(error.mean));
    EXPECT_TRUE(std::isnan(error.max));
    EXPECT_THROW(direction_error(found, std::span(ground_truth).first(2)), InvalidInput);
}

}  // namespace
}  // namespace relief
