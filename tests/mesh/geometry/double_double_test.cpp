// SPDX-License-Identifier: Apache-2.0
#include "geometry/double_double.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace relief {
namespace {

// 2^-104: sums, products and quotients lose at most a few units of the last of 106 bits.
constexpr double unit = 0x1p-104;

double distance(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble difference = a - b;
    return std::abs(difference.high + difference.low);
}

TEST(DoubleDouble, AddsWithoutError) {
    const DoubleDouble sum = DoubleDouble::exact_sum(1.0, 0x1p-80);
    EXPECT_EQ(sum.high, 1.0);
    EXPECT_EQ(sum.low, 0x1p-80);
    EXPECT_EQ(DoubleDouble::exact_sum(0x1p-80, 1.0), sum);
    EXPECT_EQ(sum - 1.0, DoubleDouble(0x1p-80));
}

TEST(DoubleDouble, MultipliesWithoutError) {
    const DoubleDouble product = DoubleDouble::exact_product(1.0 + 0x1p-40, 1.0 + 0x1p-40);
    EXPECT_EQ(product.high, 1.0 + 0x1p-39);
    EXPECT_EQ(product.low, 0x1p-80);
}

TEST(DoubleDouble, DividesAndTakesRoots) {
    const DoubleDouble third = DoubleDouble(1.0) / 3.0;
    EXPECT_LT(distance(third * 3.0, 1.0), unit);
    EXPECT_NE(third.low, 0.0);
    const DoubleDouble root = sqrt(DoubleDouble(2.0));
    EXPECT_LT(distance(root * root, 2.0), 4.0 * unit);
    EXPECT_EQ(sqrt(DoubleDouble(0.0)), DoubleDouble(0.0));
    EXPECT_TRUE(std::isnan(sqrt(DoubleDouble(-1.0)).high));
}

TEST(DoubleDouble, ComparesTheLowPart) {
    EXPECT_LT(DoubleDouble(1.0), DoubleDouble(1.0, 0x1p-80));
    EXPECT_GT(DoubleDouble(1.0), DoubleDouble(1.0, -0x1p-80));
}

DoubleDouble angle(double y, double x) {
    return upper_angle(DoubleDouble(y), DoubleDouble(x));
}

// The polynomial of the arc tangent has an error of 5e-18.
TEST(DoubleDouble, FindsAnglesInAllOctants) {
    const DoubleDouble pi(std::numbers::pi, 1.2246467991473532e-16);
    constexpr double tolerance = 2e-17;
    EXPECT_LT(distance(angle(0.0, 1.0), 0.0), tolerance);
    EXPECT_LT(distance(angle(1.0, 1.0) * 4.0, pi), 4.0 * tolerance);
    EXPECT_LT(distance(angle(1.0, 0.0) * 2.0, pi), 2.0 * tolerance);
    EXPECT_LT(distance(angle(1.0, -1.0) * 4.0, pi * 3.0), 4.0 * tolerance);
    EXPECT_LT(distance(angle(0.0, -1.0), pi), tolerance);
    // atan(1/2) + atan(1/3) = pi / 4.
    EXPECT_LT(distance((angle(1.0, 2.0) + angle(1.0, 3.0)) * 4.0, pi), 8.0 * tolerance);
    EXPECT_LT(distance(angle(2.0, 1.0) + angle(1.0, 2.0), pi * 0.5), 2.0 * tolerance);
    EXPECT_TRUE(std::isnan(angle(0.0, 0.0).high));
}

}  // namespace
}  // namespace relief
