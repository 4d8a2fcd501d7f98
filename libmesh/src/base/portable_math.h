// SPDX-License-Identifier: Apache-2.0
/// \file
/// Mathematics whose results are the same bits on every processor and with every compiler and C
/// library: functions of <cmath>, angles that compilers can vectorize, sums of two doubles, random
/// numbers, and loops that are compiled for several vector instruction sets.
///
/// The C library's functions are not used for numbers that end up in files: glibc chooses variants
/// with and without fused multiplication by the processor, whose last bits differ. Nor is `long
/// double`, which has 80 bits on x86 only.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>

#include "relief/export.h"

// Loops that are compiled for several vector instruction sets.
//
// A loop over plain arrays is written once, as a RELIEF_INLINE function. Three functions that only
// call it have the targets below, so that the compiler vectorizes the loop for each of them.
// best_vector_target() tells which one to call. The author must make sure that all three give the
// same results.
#if defined(__x86_64__)
#define RELIEF_TARGET_256 [[gnu::target("avx2,fma,bmi,bmi2"), gnu::noinline]]
#define RELIEF_TARGET_512 \
    [[gnu::target("avx2,fma,avx512f,avx512dq,avx512bw,avx512vl"), gnu::noinline]]
#else
#define RELIEF_TARGET_256 [[gnu::noinline]]
#define RELIEF_TARGET_512 [[gnu::noinline]]
#endif
#define RELIEF_INLINE [[gnu::always_inline]] inline

namespace RELIEF_API relief {
namespace detail {

/// Bits of a vector register.
enum class VectorTarget { any = 128, wide = 256, widest = 512 };

/// Returns the best target of this processor and operating system. The environment variable
/// RELIEF_VECTOR_BITS (128, 256) limits it, so that tests can compare targets.
VectorTarget best_vector_target();

}  // namespace detail
}  // namespace relief

namespace relief::detail {

/// Errors are at most 4 units of the last place, of pow() 60.
namespace RELIEF_API portable {

/// \param x  radians; not finite: NaN. Beyond 1e5 turns count as 2 * std::numbers::pi
double sin(double x);
double cos(double x);

/// \param x  radians, as for sin()
double tan(double x);

/// Range -pi to pi; 0 for (0, 0).
double atan2(double y, double x);

/// \param x  up to 700
double exp(double x);

/// \param x  0: -infinity; negative: NaN
double log(double x);

/// Returns the error function: the probability that a normal variable is within x * sqrt(2)
/// deviations.
double erf(double x);

/// \param x  0 or greater; 0, infinity and NaN are returned
/// \param y  greater than 0, and small enough for the result to be finite
double pow(double x, double y);

}  // namespace portable

/// (atan(x) / x - 1) / x^2 as a polynomial in x^2 for |x| <= tan(pi / 8), interpolated at the
/// Chebyshev nodes. The error is 5e-18 in double and 1e-10 in float.
template <typename Real>
struct ArctangentPolynomial;

template <>
struct ArctangentPolynomial<double> {
    static constexpr std::array coefficients = {
        -0.3333333333333333,  0.1999999999999552,  -0.14285714284666542, 0.11111111015256361,
        -0.09090904578123903, 0.07692183190826087, -0.06664511447381948, 0.0585814891280221,
        -0.0508544973794026,  0.03923165829558719, -0.01917688711906226};
};

template <>
struct ArctangentPolynomial<float> {
    static constexpr std::array coefficients = {-0.33333333279F,   0.19999977259F,
                                                -0.142841511936F,  0.110713650219F,
                                                -0.0862467614525F, 0.0504813851208F};
};

/// Evaluates the polynomial from coefficient `i`. Recursive because a loop would prevent the
/// vectorization of the loop around it.
template <typename Real, std::size_t i = 0>
RELIEF_INLINE Real arctangent_polynomial(Real square) {
    constexpr auto& all = ArctangentPolynomial<Real>::coefficients;
    // A local value: the compiler need not assume that it changes.
    constexpr Real coefficient = all[i];
    if constexpr (i + 1 == all.size())
        return coefficient;
    else
        return coefficient + square * arctangent_polynomial<Real, i + 1>(square);
}

/// Returns atan2(y, x) for y >= 0, 0 to pi, within 3 units of the last place. (0, 0) gives NaN.
template <typename Real>
RELIEF_INLINE Real upper_angle(Real y, Real x) {
    constexpr Real tan_of_eighth = Real(0.41421356237309503);
    constexpr Real quarter = std::numbers::pi_v<Real> / 4;
    // Reduces to the lowest octant, then to the half of it around one of its borders. Choices
    // are exact multiplications by 1 or 0: GCC vectorizes those, but compiles selections to
    // branches.
    const Real along = std::abs(x);
    const Real steep = along < y ? Real(1) : Real(0);
    const Real backward = x < 0 ? Real(1) : Real(0);
    const Real low = std::min(along, y);
    const Real high = std::max(along, y);
    const Real upper_half = low > tan_of_eighth * high ? Real(1) : Real(0);
    const Real t = (low - upper_half * high) / (high + upper_half * low);
    const Real square = t * t;
    const Real angle = upper_half * quarter + (t + t * square * arctangent_polynomial(square));
    const Real upwards = steep * (2 * quarter) + (1 - 2 * steep) * angle;
    return backward * (4 * quarter) + (1 - 2 * backward) * upwards;
}

/// Arithmetic with about 106 bits: the unevaluated sum of two doubles [Dekker 1971]. The range is
/// that of double. Infinities and NaN give NaN.
struct DoubleDouble {
    double high = 0.0;
    double low = 0.0;  ///< At most half a unit in the last place of `high`.

    constexpr DoubleDouble() = default;
    constexpr DoubleDouble(double value) : high(value) {}  // NOLINT(google-explicit-constructor)
    constexpr DoubleDouble(double high_part, double low_part) : high(high_part), low(low_part) {}

    /// Returns the sum of two doubles, without error. \param a  not smaller in size than b
    static DoubleDouble ordered_sum(double a, double b) {
        const double sum = a + b;
        return {sum, b - (sum - a)};
    }
    /// Returns the sum of two doubles, without error.
    static DoubleDouble exact_sum(double a, double b) {
        const double sum = a + b;
        const double part = sum - a;
        return {sum, (a - (sum - part)) + (b - part)};
    }
    /// Returns the product of two doubles, without error unless it underflows.
    static DoubleDouble exact_product(double a, double b) {
        const double product = a * b;
        return {product, std::fma(a, b, -product)};
    }

    friend DoubleDouble operator-(const DoubleDouble& a) { return {-a.high, -a.low}; }
    friend DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
        const DoubleDouble highs = exact_sum(a.high, b.high);
        const DoubleDouble lows = exact_sum(a.low, b.low);
        const DoubleDouble sum = ordered_sum(highs.high, highs.low + lows.high);
        return ordered_sum(sum.high, sum.low + lows.low);
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

/// Returns atan2(y, x) for y >= 0, 0 to pi, with an error of 1e-17. (0, 0) gives NaN.
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

template <int N, typename T>
bool is_finite(const glm::vec<N, T>& vector) {
    for (int i = 0; i < N; ++i) {
        if (!std::isfinite(vector[i])) return false;
    }
    return true;
}

/// The step of SplitMix64 [Steele et al. 2014] from one state to the next.
inline constexpr std::uint64_t split_mix_step = 0x9e3779b97f4a7c15ULL;

/// Mixes bits as SplitMix64 does: every bit of the input affects every bit of the result. 0 stays.
constexpr std::uint64_t mixed_bits(std::uint64_t bits) {
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ULL;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebULL;
    return bits ^ (bits >> 31);
}

/// A pseudorandom number generator: SplitMix64 [Steele et al. 2014].
class Random {
  public:
    explicit Random(std::uint32_t seed) : state_(seed) {}

    /// Returns a uniformly distributed number in [low, high).
    double between(double low, double high) {
        state_ += split_mix_step;
        return low + (high - low) * (static_cast<double>(mixed_bits(state_) >> 11) * 0x1p-53);
    }

    /// Returns a nearly Gaussian number with mean 0 and standard deviation 1, in [-6, 6]. It is a
    /// sum of 12 uniform numbers, because the last bits of logarithms depend on the machine.
    double normal() {
        double sum = -6.0;
        for (int i = 0; i < 12; ++i)
            sum += between(0.0, 1.0);
        return sum;
    }

  private:
    std::uint64_t state_;
};

}  // namespace relief::detail
