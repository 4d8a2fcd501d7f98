// SPDX-License-Identifier: Apache-2.0
/// \file
/// Arithmetic with about 106 bits: the unevaluated sum of two doubles [Dekker 1971].
///
/// The results are the same bits on every processor, unlike those of `long double`. The range is
/// that of double. Infinities and NaN give NaN.
#pragma once

#include <cmath>

#include "corner_angle.h"

namespace relief {

struct DoubleDouble {
    double high = 0.0;
    double low = 0.0;  ///< At most half a unit in the last place of `high`.

    constexpr DoubleDouble() = default;
    constexpr DoubleDouble(double value) : high(value) {}  // NOLINT(google-explicit-constructor)
    constexpr DoubleDouble(double high_part, double low_part) : high(high_part), low(low_part) {}

    /// The sum of two doubles, without error. \param a  not smaller in size than b
    static DoubleDouble ordered_sum(double a, double b) {
        const double sum = a + b;
        return {sum, b - (sum - a)};
    }
    /// The sum of two doubles, without error.
    static DoubleDouble exact_sum(double a, double b) {
        const double sum = a + b;
        const double part = sum - a;
        return {sum, (a - (sum - part)) + (b - part)};
    }
    /// The product of two doubles, without error unless it underflows.
    static DoubleDouble exact_product(double a, double b) {
        const double product = a * b;
        return {product, std::fma(a, b, -product)};
    }

    friend DoubleDouble operator-(const DoubleDouble& a) { return {-a.high, -a.low}; }
    friend DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
        const DoubleDouble high = exact_sum(a.high, b.high);
        const DoubleDouble low = exact_sum(a.low, b.low);
        const DoubleDouble sum = ordered_sum(high.high, high.low + low.high);
        return ordered_sum(sum.high, sum.low + low.low);
    }
    friend DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }
    friend DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
        const DoubleDouble product = exact_product(a.high, b.high);
        return ordered_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
    }
    friend DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
        const double first = a.high / b.high;
        const DoubleDouble rest = a - b * first;
        const double second = rest.high / b.high;
        return ordered_sum(first, second) + (rest - b * second).high / b.high;
    }
    DoubleDouble& operator+=(const DoubleDouble& other) { return *this = *this + other; }

    /// By value, as doubles compare.
    friend auto operator<=>(const DoubleDouble& a, const DoubleDouble& b) = default;

    friend DoubleDouble sqrt(const DoubleDouble& a) {
        if (!(a.high > 0.0)) return std::sqrt(a.high);
        const double root = std::sqrt(a.high);
        return ordered_sum(root, (a - exact_product(root, root)).high / (2.0 * root));
    }
};

/// atan2(y, x) for y >= 0, 0 to pi, with an error of 1e-17. (0, 0) gives NaN.
inline DoubleDouble upper_angle(const DoubleDouble& y, const DoubleDouble& x) {
    constexpr DoubleDouble quarter(0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55);
    constexpr double tan_of_eighth = 0.41421356237309503;
    const bool backward = x.high < 0.0;
    const DoubleDouble along = backward ? -x : x;
    const bool steep = along < y;
    const DoubleDouble& low = steep ? along : y;
    const DoubleDouble& high = steep ? y : along;
    const bool upper_half = low.high > tan_of_eighth * high.high;
    const DoubleDouble t = upper_half ? (low - high) / (high + low) : low / high;
    const double square = t.high * t.high;
    // The second term is at most 0.024, so its rounding in double does not matter.
    DoubleDouble angle = t + t.high * square * arctangent_polynomial(square);
    if (upper_half) angle += quarter;
    if (steep) angle = quarter * 2.0 - angle;
    return backward ? quarter * 4.0 - angle : angle;
}

}  // namespace relief
