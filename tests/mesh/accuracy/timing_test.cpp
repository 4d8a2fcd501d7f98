// SPDX-License-Identifier: Apache-2.0
// Medians and spreads by hand, the order of repeated work, and what clocks cannot help but show.
#include "relief/mesh/timing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "relief/mesh/error.h"
#include "support/message_of.h"

namespace relief {
namespace {

using testing::ElementsAre;
using testing::Pair;

constexpr double clock_rounding = 1e-12;  // Ticks are whole; their sums in seconds are rounded.

TEST(TimeStatistics, IsTakenBetweenMeasurements) {
    const TimeStatistics odd = time_statistics({5, 1, 3, 2, 4, 11, 8, 7, 6, 10, 9});  // 1 to 11.
    EXPECT_EQ(odd.median, 6.0);
    EXPECT_EQ(odd.p10, 2.0);
    EXPECT_EQ(odd.p90, 10.0);
    EXPECT_EQ(odd.count, 11U);
    const TimeStatistics even = time_statistics({4, 1});
    EXPECT_EQ(even.median, 2.5);
    EXPECT_NEAR(even.p10, 1.3, 1e-12);
    EXPECT_NEAR(even.p90, 3.7, 1e-12);
}

TEST(TimeStatistics, OfOneIsThatOneAndOfNoneNothing) {
    EXPECT_EQ(time_statistics({7}).median, 7.0);
    EXPECT_EQ(time_statistics({7}).p10, 7.0);
    EXPECT_EQ(time_statistics({7}).p90, 7.0);
    EXPECT_EQ(time_statistics({}).count, 0U);
    EXPECT_EQ(time_statistics({}).median, 0.0);
}

TEST(Stopwatch, LapsAddUpToTheWhole) {
    const Stopwatch whole;
    Stopwatch parts;
    const double first = parts.lap();
    const double second = parts.lap();
    EXPECT_GE(first, 0.0);
    EXPECT_GE(second, 0.0);
    EXPECT_GE(parts.seconds(), 0.0);
    EXPECT_LE(first + second, whole.seconds() + clock_rounding);
}

TEST(SecondsOf, IsTheTimeOfTheWorkWhichIsDoneOnce) {
    int done = 0;
    const Stopwatch around;
    const double seconds = seconds_of([&] { ++done; });
    EXPECT_EQ(done, 1);
    EXPECT_GE(seconds, 0.0);
    EXPECT_LE(seconds, around.seconds());
}

TEST(Interleave, TakesTurnsAndWarmsUpFirst) {
    std::vector<std::pair<std::size_t, bool>> calls;
    interleave(2, {.counted = 2, .warm_up = 1},
               [&](std::size_t thing, bool counted) { calls.emplace_back(thing, counted); });
    EXPECT_THAT(calls, ElementsAre(Pair(0, false), Pair(1, false), Pair(0, true), Pair(1, true),
                                   Pair(0, true), Pair(1, true)));
}

TEST(MedianDifference, IsFreeOfWhatBothShare) {
    EXPECT_EQ(median_difference({12, 110, 52}, {10, 109, 49}), 2.0);
    EXPECT_EQ(test::message_of<InvalidInput>([] {
                  median_difference({1, 2}, {1});
              }),
              "2 measurements cannot be compared with 1 round by round");
}

}  // namespace
}  // namespace relief
