// SPDX-License-Identifier: Apache-2.0
// Functions that give the same bits everywhere: held to the C library's in long steps, and to what
// they gave once, bit for bit.
#include "geometry/portable_math.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace relief {
namespace {

constexpr double ulp = std::numeric_limits<double>::epsilon();

/// Numbers from `first` to `last` that are not round.
template <typename Each>
void each_between(double first, double last, const Each& each) {
    for (int i = 0; i <= 4000; ++i)
        each(first + (last - first) * (i / 4000.0) * 0.99991234567);
}

TEST(PortableMath, IsWithinAFewUnitsOfTheLastPlace) {
    each_between(-30.0, 30.0, [](double x) {
        // Near their zeros, to the rounding of the reduced angle.
        EXPECT_NEAR(portable::sin(x), std::sin(x), 2.0 * ulp * std::abs(std::sin(x)) + 1e-19) << x;
        EXPECT_NEAR(portable::cos(x), std::cos(x), 2.0 * ulp * std::abs(std::cos(x)) + 1e-19) << x;
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

}  // namespace
}  // namespace relief
