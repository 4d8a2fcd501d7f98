// SPDX-License-Identifier: Apache-2.0
// Mathematical functions with the same bits on every machine, corner angles and double-double
// arithmetic, against the C library and higher precision.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "portable_math.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr double ulp = std::numeric_limits<double>::epsilon();

/// Visits irregular numbers from `first` to `last`.
template <typename Each>
void each_between(double first, double last, const Each& each) {
    for (int i = 0; i <= 4000; ++i)
        each(first + (last - first) * (i / 4000.0) * 0.99991234567);
}

TEST(PortableMath, IsWithinAFewUlps) {
    each_between(-30.0, 30.0, [](double x) {
        // Near zeros, the error is that of the reduced angle.
        EXPECT_NEAR(portable::sin(x), std::sin(x), 2.0 * ulp * std::abs(std::sin(x)) + 1e-19) << x;
        EXPECT_NEAR(portable::cos(x), std::cos(x), 2.0 * ulp * std::abs(std::cos(x)) + 1e-19) << x;
    });
    each_between(-1.5, 1.5, [](double x) {
        EXPECT_NEAR(portable::tan(x), std::tan(x), 4.0 * ulp * std::abs(std::tan(x))) << x;
    });
    each_between(-1e5, 1e5, [](double x) {
        EXPECT_NEAR(portable::sin(x), std::sin(x), 2.0 * ulp) << x;
        EXPECT_NEAR(portable::cos(x), std::cos(x), 2.0 * ulp) << x;
    });
    each_between(-700.0, 700.0, [](double x) {
        EXPECT_NEAR(portable::exp(x) / std::exp(x), 1.0, 4.0 * ulp) << x;
    });
    each_between(-7.0, 7.0, [](double x) {
        // exp(-x^2) multiplies the rounding error of x^2, which is at most 36, by x^2.
        EXPECT_NEAR(portable::erf(x), std::erf(x), 36.0 * ulp * std::abs(std::erf(x))) << x;
    });
    each_between(1e-9, 8.0, [](double x) {
        EXPECT_NEAR(portable::log(x), std::log(x), 4.0 * ulp * std::abs(std::log(x))) << x;
        EXPECT_NEAR(portable::pow(x, 2.4) / std::pow(x, 2.4), 1.0, 60.0 * ulp) << x;
        EXPECT_NEAR(portable::atan2(x - 4.0, 1.0), std::atan2(x - 4.0, 1.0), 4.0 * ulp) << x;
        EXPECT_NEAR(portable::atan2(x - 4.0, -0.5), std::atan2(x - 4.0, -0.5), 4.0 * ulp) << x;
    });
}

TEST(PortableMath, KnowsItsSpecialValues) {
    EXPECT_EQ(portable::sin(0.0), 0.0);
    EXPECT_EQ(portable::cos(0.0), 1.0);
    EXPECT_EQ(portable::sin(0.5 * std::numbers::pi), 1.0);
    EXPECT_EQ(portable::cos(std::numbers::pi), -1.0);
    EXPECT_EQ(portable::exp(0.0), 1.0);
    EXPECT_EQ(portable::exp(-1e9), 0.0);
    EXPECT_EQ(portable::log(1.0), 0.0);
    EXPECT_EQ(portable::log(0.0), -std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::isnan(portable::log(-1.0)));
    EXPECT_EQ(portable::erf(0.0), 0.0);
    EXPECT_EQ(portable::erf(-100.0), -1.0);
    EXPECT_TRUE(std::isnan(portable::erf(std::nan(""))));
    EXPECT_EQ(portable::pow(1.0, 2.4), 1.0);
    EXPECT_EQ(portable::pow(0.0, 2.4), 0.0);
    EXPECT_EQ(portable::pow(std::numeric_limits<double>::infinity(), 2.4),
              std::numeric_limits<double>::infinity());
    EXPECT_EQ(portable::atan2(0.0, 0.0), 0.0);
    EXPECT_EQ(portable::atan2(-1.0, 0.0), -0.5 * std::numbers::pi);
    EXPECT_TRUE(std::isnan(portable::sin(std::nan(""))));
    EXPECT_TRUE(std::isnan(portable::cos(std::numeric_limits<double>::infinity())));
    EXPECT_LE(std::abs(portable::sin(1e300)), 1.0);
}

TEST(PortableMath, GivesTheSameBitsEverywhere) {
    // FNV-1a over the bits of all results.
    std::uint64_t hash = 0xcbf29ce484222325U;
    const auto add = [&](double result) {
        const auto bits = std::bit_cast<std::uint64_t>(result);
        for (int byte = 0; byte < 8; ++byte)
            hash = (hash ^ ((bits >> (8 * byte)) & 0xff)) * 0x100000001b3U;
    };
    each_between(-30.0, 30.0, [&](double x) {
        add(portable::sin(x));
        add(portable::cos(x));
        add(portable::exp(x));
        add(portable::atan2(x, 1.5));
        add(portable::log(x * x + 1e-3));
        add(portable::pow(std::abs(x), 1.0 / 2.4));
    });
    EXPECT_EQ(hash, 0xf53b6d875ceb64cU);
}

/// Returns the largest error over directions in the upper half plane, in units of the last place.
template <typename Real>
double worst_error() {
    double worst = 0.0;
    const int steps = 100003;
    for (int i = 0; i <= steps; ++i) {
        const double angle = std::numbers::pi * i / steps;
        for (const double length : {1e-12, 1.0, 3.7, 1e12}) {
            const auto x = static_cast<Real>(length * std::cos(angle));
            const auto y = std::abs(static_cast<Real>(length * std::sin(angle)));
            const long double exact =
                std::atan2(static_cast<long double>(y), static_cast<long double>(x));
            const auto error = static_cast<double>(std::abs(upper_angle(y, x) - exact));
            const double step = static_cast<double>(std::numeric_limits<Real>::epsilon()) *
                                std::exp2(std::floor(std::log2(static_cast<double>(exact))));
            if (exact > 0) worst = std::max(worst, error / step);
        }
    }
    return worst;
}

TEST(UpperAngle, IsWithinThreeUlps) {
    EXPECT_LE(worst_error<double>(), 3.0);
    EXPECT_LE(worst_error<float>(), 3.0);
    EXPECT_GT(worst_error<double>(), 0.0);
}

TEST(UpperAngle, IsExactAtRepresentableAngles) {
    EXPECT_EQ(upper_angle(0.0, 1.0), 0.0);
    EXPECT_EQ(upper_angle(0.0, -1.0), std::numbers::pi);
    EXPECT_EQ(upper_angle(2.0, 0.0), std::numbers::pi / 2);
    EXPECT_EQ(upper_angle(3.0, 3.0), std::numbers::pi / 4);
    EXPECT_EQ(upper_angle(3.0, -3.0), 3 * (std::numbers::pi / 4));
}

TEST(UpperAngle, IsAccurateForTinyAngles) {
    // For an angle of 1e-6, acos of a float cosine would be 0.
    EXPECT_NEAR(upper_angle(1e-6F, 1.0F), 1e-6F, 1e-13F);
    EXPECT_NEAR(upper_angle(1e-300, 1e-294), 1e-6, 1e-18);
}

// 2^-104: sums, products and quotients lose at most a few units of the last of 106 bits.
constexpr double smallest_step = 0x1p-104;

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

TEST(DoubleDouble, DividesAndComputesRoots) {
    const DoubleDouble third = DoubleDouble(1.0) / 3.0;
    EXPECT_LT(distance(third * 3.0, 1.0), smallest_step);
    EXPECT_NE(third.low, 0.0);
    const DoubleDouble root = sqrt(DoubleDouble(2.0));
    EXPECT_LT(distance(root * root, 2.0), 4.0 * smallest_step);
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
