// SPDX-License-Identifier: Apache-2.0
// The envelope of parabolas against every column tried.
#include "bake/edge_padding.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace relief {
namespace {

struct Place {
    int column, distance;
};

void expect_as_tried(const std::vector<Place>& places, int width) {
    NearestColumns nearest;
    for (const Place& place : places)
        nearest.add(place.column, place.distance);
    for (int column = 0; column < width; ++column) {
        std::int64_t least = std::numeric_limits<std::int64_t>::max();
        std::vector<int> expected;
        for (const Place& place : places) {
            const std::int64_t across = column - place.column;
            const std::int64_t squared =
                across * across + std::int64_t{place.distance} * place.distance;
            if (squared > least) continue;
            if (squared < least) expected.clear();
            least = squared;
            expected.push_back(place.column);
        }
        ASSERT_EQ(nearest.squared_distance(column), least) << column;
        std::vector<int> found;
        nearest.for_nearest(column, [&](int other) { found.push_back(other); });
        ASSERT_EQ(found, expected) << column;
    }
}

TEST(NearestColumns, FindsAllThatAreEquallyNear) {
    std::mt19937 random(5);
    for (int round = 0; round < 400; ++round) {
        std::vector<Place> places;
        for (int column = 0; column < 90; ++column) {
            if (random() % 3 != 0) places.push_back({column, static_cast<int>(random() % 40)});
        }
        if (!places.empty()) expect_as_tried(places, 90);
    }
}

/// Around the 12 whole points of a circle of radius 5, all are as near to its middle.
TEST(NearestColumns, FindsMoreThanTwo) {
    const std::vector<Place> circle = {{0, 0}, {1, 3}, {2, 4}, {5, 5}, {8, 4}, {9, 3}, {10, 0}};
    expect_as_tried(circle, 11);
    NearestColumns nearest;
    for (const Place& place : circle)
        nearest.add(place.column, place.distance);
    EXPECT_EQ(nearest.squared_distance(5), 25);
    int count = 0;
    nearest.for_nearest(5, [&](int) { ++count; });
    EXPECT_EQ(count, 7);
}

TEST(NearestColumns, IsExactForTheLongestRows) {
    expect_as_tried({{0, 65535}, {65535, 65535}}, 65536);
    expect_as_tried({{0, 3}, {65534, 3}}, 65536);
}

}  // namespace
}  // namespace relief
