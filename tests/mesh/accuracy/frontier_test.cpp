// SPDX-License-Identifier: Apache-2.0
// Frontiers by hand, and against the definition on random prices.
#include "relief/mesh/frontier.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "random.h"

namespace relief {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<bool> of(std::vector<MethodCost> prices) {
    return pareto_optimal(prices);
}

TEST(Frontier, HoldsWhatNothingBeats) {
    EXPECT_THAT(of({{1.0, 3.0}, {2.0, 2.0}, {2.5, 2.5}, {3.0, 1.0}}),
                ElementsAre(true, true, false, true));
    EXPECT_THAT(of({}), IsEmpty());
    EXPECT_THAT(of({{5.0, 5.0}}), ElementsAre(true));
}

TEST(Frontier, OfEqualTimesTakesTheTruerAndOfEqualErrorsTheFaster) {
    EXPECT_THAT(of({{1.0, 1.0}, {2.0, 1.0}}), ElementsAre(true, false));
    EXPECT_THAT(of({{1.0, 2.0}, {1.0, 1.0}}), ElementsAre(false, true));
}

TEST(Frontier, EqualOnesStandOrFallTogether) {
    EXPECT_THAT(of({{1.0, 1.0}, {1.0, 1.0}, {2.0, 2.0}, {2.0, 2.0}}),
                ElementsAre(true, true, false, false));
}

TEST(Frontier, WhatIsNotKnownIsNeverOnIt) {
    EXPECT_THAT(of({{nan, 0.0}, {0.0, nan}, {1.0, 1.0}}), ElementsAre(false, false, true));
    EXPECT_THAT(of({{infinity, 0.5}, {1.0, 1.0}}), ElementsAre(true, true));
}

TEST(Frontier, IsThatOfTheDefinitionOnRandomPrices) {
    Random random(3);
    for (int round = 0; round < 200; ++round) {
        std::vector<MethodCost> prices(12);
        for (MethodCost& price : prices)  // Few values, so that there are ties.
            price = {std::floor(random.between(0, 6)), std::floor(random.between(0, 6))};
        const std::vector<bool> found = pareto_optimal(prices);
        for (std::size_t i = 0; i < prices.size(); ++i) {
            const bool is_beaten =
                std::any_of(prices.begin(), prices.end(), [&](const MethodCost& other) {
                    return other.error <= prices[i].error && other.time <= prices[i].time &&
                           (other.error < prices[i].error || other.time < prices[i].time);
                });
            EXPECT_NE(found[i], is_beaten);
        }
    }
}

}  // namespace
}  // namespace relief
