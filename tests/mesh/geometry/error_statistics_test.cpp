// SPDX-License-Identifier: Apache-2.0
// Error statistics and timings against hand-computed values.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "geometry/error_accumulator.h"
#include "portable_math.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "support/invariants.h"

namespace relief {
using namespace relief::detail;

namespace {

using testing::ElementsAre;
using testing::Pair;

TEST(DegreesBetween, ResolvesTinyAngles) {
    EXPECT_DOUBLE_EQ(degrees_between({2, 0, 0}, {0, 0, 5}), 90.0);
    EXPECT_DOUBLE_EQ(degrees_between({1, 0, 0}, {-3, 0, 0}), 180.0);
    EXPECT_EQ(degrees_between({1, 2, 3}, {2, 4, 6}), 0.0);
    EXPECT_NEAR(degrees_between({1, 0, 0}, {1, 1e-9, 0}), 57.29577951e-9, 1e-17);
}

TEST(DegreesBetween, IsNaNForZeroVectors) {
    EXPECT_TRUE(std::isnan(degrees_between({0, 0, 0}, {0, 0, 1})));
    EXPECT_TRUE(
        std::isnan(degrees_between({std::numeric_limits<double>::infinity(), 0, 0}, {0, 0, 1})));
}

TEST(DirectionErrors, IsRmsMeanAndLargestOfThoseThatCount) {
    const std::array<glm::vec3, 3> found = {glm::vec3(0, 0, 1), {0, 1, 1}, {1, 0, 0}};
    const std::array<glm::dvec3, 3> reference = {glm::dvec3(0, 0, 1), {0, 0, 1}, {0, 0, 1}};
    const ErrorStats all = direction_error(found, reference);
    EXPECT_EQ(all.count, 3U);
    EXPECT_DOUBLE_EQ(all.mean, 45.0);
    EXPECT_DOUBLE_EQ(all.rms, std::sqrt((45.0 * 45.0 + 90.0 * 90.0) / 3.0));
    EXPECT_DOUBLE_EQ(all.max, 90.0);
    const std::array<unsigned char, 3> counts = {1, 1, 0};
    EXPECT_DOUBLE_EQ(direction_error(found, reference, counts).max, 45.0);
    EXPECT_EQ(direction_error({}, {}).count, 0U);
}

TEST(DirectionErrors, DoesNotHideADirectionThatIsNone) {
    const std::array<glm::vec3, 3> found = {glm::vec3(0, 0, 1), {0, 0, 0}, {1, 0, 0}};
    const std::array<glm::dvec3, 3> reference = {glm::dvec3(0, 0, 1), {0, 0, 1}, {0, 0, 1}};
    const ErrorStats error = direction_error(found, reference);
    EXPECT_TRUE(std::isnan(error.rms));
    EXPECT_TRUE(std::isnan(error.mean));
    EXPECT_TRUE(std::isnan(error.max));
    EXPECT_THROW(direction_error(found, std::span(reference).first(2)), InvalidInput);
}

TEST(ErrorStats, EmptyIsAllZeros) {
    EXPECT_EQ(error_stats({}), ErrorStats());
}

TEST(ErrorStats, SummarizesItsValues) {
    const ErrorStats result = error_stats({4.0F, 0.0F, 3.0F, 0.0F});
    EXPECT_EQ(result.count, 4U);
    EXPECT_EQ(result.undefined, 0U);
    EXPECT_DOUBLE_EQ(result.rms, 2.5);
    EXPECT_DOUBLE_EQ(result.mean, 1.75);
    EXPECT_EQ(result.median, 0.0) << "half do not exceed 0";
    EXPECT_EQ(result.p99, 4.0);
    EXPECT_EQ(result.max, 4.0);
}

TEST(ErrorStats, PercentilesAreRanks) {
    std::vector<float> degrees;
    for (int i = 200; i > 0; --i)
        degrees.push_back(static_cast<float>(i) / 2.0F);
    const ErrorStats result = error_stats(degrees);
    EXPECT_EQ(result.median, 50.0);
    EXPECT_EQ(result.p90, 90.0);
    EXPECT_EQ(result.p99, 99.0);
    EXPECT_EQ(result.max, 100.0);
}

TEST(ErrorStats, BinsHoldTheirUpperEnd) {
    const ErrorStats result = error_stats(
        {0.0F, 0.005F, 0.05F, 1.0F, 1.001F, 5.0F, 45.0F, 60.0F, 90.0F, 90.5F, 180.0F, 180.00002F});
    EXPECT_THAT(result.histogram, ElementsAre(2, 1, 1, 2, 1, 2, 3));
}

TEST(ErrorStats, CountsNaNSeparately) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const ErrorStats result = error_stats({nan, 2.0F, nan});
    EXPECT_EQ(result.count, 1U);
    EXPECT_EQ(result.undefined, 2U);
    EXPECT_EQ(result.mean, 2.0);
}

/// Percentiles are the upper ends of bins, of which a factor of two has 64 or more.
constexpr double bin_width = 1.0 / 64.0;

/// Angles of all sizes that bins distinguish: 1e-6 to 170 degrees.
std::vector<float> angles_of_all_sizes() {
    std::vector<float> degrees;
    for (int i = 0; i < 1000; ++i)
        degrees.push_back(
            static_cast<float>(std::pow(10.0, -6.0 + 8.23 * ((i * 617) % 1000) / 1000.0)));
    return degrees;
}

TEST(ErrorMoments, AreRmsMeanAndMaximum) {
    ErrorMoments moments;
    for (const double degrees : {4.0, 0.0, 3.0, 0.0})
        moments.add(degrees);
    EXPECT_EQ(moments.count(), 4U);
    EXPECT_EQ(moments.rms(), 2.5);
    EXPECT_EQ(moments.mean(), 1.75);
    EXPECT_EQ(moments.max(), 4.0);
}

TEST(ErrorMoments, EmptyAreZeros) {
    const ErrorMoments nothing;
    EXPECT_EQ(nothing.count(), 0U);
    EXPECT_EQ(nothing.rms(), 0.0);
    EXPECT_EQ(nothing.mean(), 0.0);
    EXPECT_EQ(nothing.max(), 0.0);
}

TEST(ErrorMoments, PartsCombineToTheWhole) {
    ErrorMoments whole, first, second;
    for (int i = 0; i < 90; ++i) {  // Sums of whole degrees are exact.
        whole.add(i);
        (i < 17 ? first : second).add(i);
    }
    first.add(second);
    first.add(ErrorMoments());
    EXPECT_EQ(first.count(), whole.count());
    EXPECT_EQ(first.rms(), whole.rms());
    EXPECT_EQ(first.mean(), whole.mean());
    EXPECT_EQ(first.max(), whole.max());
}

TEST(ErrorMoments, PropagateNaN) {
    ErrorMoments moments;
    for (const double degrees : {2.0, std::numeric_limits<double>::quiet_NaN(), 5.0})
        moments.add(degrees);
    EXPECT_TRUE(std::isnan(moments.rms()));
    EXPECT_TRUE(std::isnan(moments.mean()));
    EXPECT_EQ(moments.max(), 5.0);
    EXPECT_EQ(moments.count(), 3U);
}

TEST(ErrorAccumulator, IsTheDistributionInShort) {
    const std::vector<float> degrees = angles_of_all_sizes();
    ErrorAccumulator sum;
    for (const float angle : degrees)
        sum.add(static_cast<double>(angle));
    const ErrorStats summary = sum.stats();
    const ErrorStats all = error_stats(degrees);
    EXPECT_EQ(summary.count, all.count);
    EXPECT_EQ(summary.rms, all.rms);
    EXPECT_EQ(summary.mean, all.mean);
    EXPECT_EQ(summary.max, all.max);
    EXPECT_EQ(summary.histogram, all.histogram);
    for (const auto& [rough, exact] :
         {std::pair(summary.median, all.median), std::pair(summary.p90, all.p90),
          std::pair(summary.p99, all.p99)}) {
        EXPECT_GE(rough, exact);
        EXPECT_LE(rough, exact * (1.0 + bin_width));
    }
}

TEST(ErrorAccumulator, HasAPercentileNoFurtherOffThanABin) {
    for (const float angle : angles_of_all_sizes()) {
        ErrorAccumulator sum;
        for (int i = 0; i < 99; ++i)
            sum.add(static_cast<double>(angle));
        sum.add(180.0);
        const double p99 = sum.stats().p99;
        EXPECT_GE(p99, static_cast<double>(angle));
        EXPECT_LE(p99, static_cast<double>(angle) * (1.0 + bin_width));
    }
}

TEST(ErrorAccumulator, PartsCombineToTheWhole) {
    ErrorAccumulator whole, first, second;
    for (int i = 0; i < 180; ++i) {  // Sums of whole degrees are exact.
        whole.add(i);
        (i % 3 == 0 ? first : second).add(i);
    }
    ErrorAccumulator both;
    both.add(first);
    both.add(second);
    EXPECT_EQ(both.stats().count, 180U);
    EXPECT_EQ(both.stats().rms, whole.stats().rms);
    EXPECT_EQ(both.stats().mean, whole.stats().mean);
    EXPECT_EQ(both.stats().p99, whole.stats().p99);
    EXPECT_EQ(both.stats().max, 179.0);
}

TEST(ErrorAccumulator, EmptyIsZeroAndZeroAnglesAreExact) {
    EXPECT_EQ(ErrorAccumulator().stats().count, 0U);
    EXPECT_EQ(ErrorAccumulator().stats().p99, 0.0);
    ErrorAccumulator exact;
    exact.add(0.0);
    EXPECT_EQ(exact.stats().count, 1U);
    EXPECT_EQ(exact.stats().p99, 0.0) << "never more than the greatest";
    EXPECT_EQ(exact.stats().max, 0.0);
}

TEST(ErrorAccumulator, CountsUndefinedAnglesApart) {
    ErrorAccumulator sum, other;
    for (const double degrees : {2.0, std::numeric_limits<double>::quiet_NaN(), 4.0})
        sum.add(degrees);
    other.add(std::numeric_limits<double>::quiet_NaN());
    sum.add(other);
    EXPECT_EQ(sum.stats().count, 2U);
    EXPECT_EQ(sum.stats().undefined, 2U);
    EXPECT_EQ(sum.stats().mean, 3.0);
}

constexpr double clock_rounding = 1e-12;  // Ticks are integers; their sums in seconds are rounded.

TEST(Quantile, InterpolatesBetweenOrderedValues) {
    const std::vector<double> values = {1, 2, 4, 8};
    EXPECT_EQ(quantile(values, 0.0), 1.0);
    EXPECT_EQ(quantile(values, 0.25), 1.75);
    EXPECT_EQ(quantile(values, 0.5), 3.0);
    EXPECT_EQ(quantile(values, 1.0), 8.0);
    EXPECT_EQ(quantile(std::vector{7.0}, 0.3), 7.0);
}

TEST(TimeStatistics, IsTakenBetweenMeasurements) {
    const TimeStatistics odd =
        time_statistics({5, 1, 3, 2, 4, 11, 8, 7, 6, 10, 9});  // The values 1 to 11.
    EXPECT_EQ(odd.median, 6.0);
    EXPECT_EQ(odd.p10, 2.0);
    EXPECT_EQ(odd.p90, 10.0);
    EXPECT_EQ(odd.count, 11U);
    const TimeStatistics even = time_statistics({4, 1});
    EXPECT_EQ(even.median, 2.5);
    EXPECT_NEAR(even.p10, 1.3, 1e-12);
    EXPECT_NEAR(even.p90, 3.7, 1e-12);
}

TEST(TimeStatistics, HandleOneAndNoTime) {
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

TEST(Interleave, AlternatesAfterAWarmUp) {
    std::vector<std::pair<std::size_t, bool>> calls;
    interleave(2, {.counted = 2, .warm_up = 1},
               [&](std::size_t thing, bool counted) { calls.emplace_back(thing, counted); });
    EXPECT_THAT(calls, ElementsAre(Pair(0, false), Pair(1, false), Pair(0, true), Pair(1, true),
                                   Pair(0, true), Pair(1, true)));
}

TEST(MedianDifference, CancelsCommonDrift) {
    EXPECT_EQ(median_difference({12, 110, 52}, {10, 109, 49}), 2.0);
    EXPECT_EQ(test::message_of<InvalidInput>([] {
                  median_difference({1, 2}, {1});
              }),
              "2 measurements cannot be compared with 1 round by round");
}

}  // namespace
}  // namespace relief
