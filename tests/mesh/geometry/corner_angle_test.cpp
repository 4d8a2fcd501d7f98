// SPDX-License-Identifier: Apache-2.0
// The angle by our own polynomial, beside the C library's in long double.
#include "geometry/corner_angle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace relief {
namespace {

/// The largest error over directions all around the upper half, in units of the last place.
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
            const double unit = static_cast<double>(std::numeric_limits<Real>::epsilon()) *
                                std::exp2(std::floor(std::log2(static_cast<double>(exact))));
            if (exact > 0) worst = std::max(worst, error / unit);
        }
    }
    return worst;
}

TEST(UpperAngle, IsWithinThreeUnitsOfTheLastPlace) {
    EXPECT_LE(worst_error<double>(), 3.0);
    EXPECT_LE(worst_error<float>(), 3.0);
    EXPECT_GT(worst_error<double>(), 0.0);
}

TEST(UpperAngle, IsExactWhereItCanBe) {
    EXPECT_EQ(upper_angle(0.0, 1.0), 0.0);
    EXPECT_EQ(upper_angle(0.0, -1.0), std::numbers::pi);
    EXPECT_EQ(upper_angle(2.0, 0.0), std::numbers::pi / 2);
    EXPECT_EQ(upper_angle(3.0, 3.0), std::numbers::pi / 4);
    EXPECT_EQ(upper_angle(3.0, -3.0), 3 * (std::numbers::pi / 4));
}

TEST(UpperAngle, KeepsItsDigitsWhereArcCosinesLoseThem) {
    // An angle of a millionth: acos of a float's cosine would be 0.
    EXPECT_NEAR(upper_angle(1e-6F, 1.0F), 1e-6F, 1e-13F);
    EXPECT_NEAR(upper_angle(1e-300, 1e-294), 1e-6, 1e-18);
}

}  // namespace
}  // namespace relief
