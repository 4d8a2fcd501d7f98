// SPDX-License-Identifier: Apache-2.0
// Plain additions, multiplications and divisions, which IEEE 754 rounds in one way only; relief is
// compiled without contraction.
#include "portable_math.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <numbers>
#include <string_view>

namespace relief::detail::portable {
namespace {

/// Remainder of an angle modulo a quarter turn, from -pi/4 to pi/4.
struct Reduced {
    double angle;
    int quarters;
};

/// pi/2 as a sum of three terms. The first two have 33 bits, so their products with an integer are
/// exact.
Reduced reduced(double x) {
    constexpr double first = 0x1.921fb544p+0;
    constexpr double second = 0x1.0b4611a6p-34;
    constexpr double third = 0x1.3198a2e037073p-69;
    // For larger values the products are not exact. The remainder is that of a rounded turn.
    if (!(std::abs(x) <= 1e5)) x = std::fmod(x, 2.0 * std::numbers::pi);
    if (std::isnan(x)) return {x, 0};
    const double count = std::floor(x * (2.0 / std::numbers::pi) + 0.5);
    const double angle = ((x - count * first) - count * second) - count * third;
    return {angle, static_cast<int>(static_cast<long long>(count) & 3)};
}

/// 1 / n! for n = first, first - 2, ... with the signs of sine's and cosine's Taylor series.
template <int first>
constexpr auto taylor_coefficients() {
    std::array<double, static_cast<std::size_t>(first / 2)> all{};
    int n = first;
    for (double& coefficient : all) {
        double factorial = 1.0;  // Exact up to 18!.
        for (int k = 2; k <= n; ++k)
            factorial *= k;
        coefficient = (n / 2 % 2 == 0 ? 1.0 : -1.0) / factorial;
        n -= 2;
    }
    return all;
}

/// Terms up to x^17. The truncation error is less than 1e-19.
double sine_series(double x) {
    constexpr auto coefficients = taylor_coefficients<17>();
    const double square = x * x;
    double sum = 0.0;
    for (const double coefficient : coefficients)
        sum = coefficient + square * sum;
    return x + x * (square * sum);
}

double cosine_series(double x) {
    constexpr auto coefficients = taylor_coefficients<18>();
    const double square = x * x;
    double sum = 0.0;
    for (const double coefficient : coefficients)
        sum = coefficient + square * sum;
    return 1.0 + square * sum;
}

double sine_of(const Reduced& reduced) {
    switch (reduced.quarters) {
        case 0:
            return sine_series(reduced.angle);
        case 1:
            return cosine_series(reduced.angle);
        case 2:
            return -sine_series(reduced.angle);
        default:
            return -cosine_series(reduced.angle);
    }
}

constexpr double ln2_first = 0x1.62e42feep-1;  // It has 32 bits.
constexpr double ln2_second = 0x1.a39ef35793c76p-33;

}  // namespace

double sin(double x) {
    return sine_of(reduced(x));
}

double cos(double x) {
    Reduced later = reduced(x);
    later.quarters = (later.quarters + 1) & 3;
    return sine_of(later);
}

double tan(double x) {
    return sin(x) / cos(x);
}

double atan2(double y, double x) {
    if (x == 0.0 && y == 0.0) return 0.0;
    return y < 0.0 ? -upper_angle(-y, x) : upper_angle(y, x);
}

double exp(double x) {
    if (x < -746.0) return 0.0;
    const double count = std::floor(x * std::numbers::log2e + 0.5);
    const double rest = (x - count * ln2_first) - count * ln2_second;
    double sum = 0.0;
    for (int n = 15; n >= 1; --n)
        sum = (1.0 + sum) * (rest / n);
    return std::ldexp(1.0 + sum, static_cast<int>(count));
}

double log(double x) {
    if (!(x > 0.0) || !std::isfinite(x)) return std::log(x);  // -infinity, infinity or NaN
    int power = 0;
    double share = std::frexp(x, &power);
    if (share < 0.70710678118654752) {
        share *= 2.0;
        --power;
    }
    // log(share) = 2 artanh(s), and s is at most 0.1716 in size.
    const double s = (share - 1.0) / (share + 1.0);
    const double square = s * s;
    double sum = 0.0;
    for (int n = 23; n >= 3; n -= 2)
        sum = (1.0 / n + sum) * square;
    return power * ln2_first + (power * ln2_second + (2.0 * s + 2.0 * s * sum));
}

double pow(double x, double y) {
    return x > 0.0 && std::isfinite(x) ? exp(y * log(x)) : x;
}

double erf(double x) {
    const double size = std::abs(x);
    if (!(size < 6.0)) return std::isnan(x) ? x : std::copysign(1.0, x);
    // 2/sqrt(pi) exp(-x^2) (x + 2/3 x^3 + 4/15 x^5 + ...) has no cancellation.
    double term = size;
    double sum = size;
    for (int n = 1; term > 1e-17 * sum; ++n) {
        term *= 2.0 * size * size / (2 * n + 1);
        sum += term;
    }
    const double result = 2.0 * std::numbers::inv_sqrtpi * exp(-size * size) * sum;
    return std::copysign(std::min(result, 1.0), x);
}

}  // namespace relief::detail::portable

namespace relief::detail {
namespace {

VectorTarget of_processor() {
// GCC for Windows does not align the stack for vectors of 256 bits and more (its bug 54412).
#if defined(__x86_64__) && !(defined(_WIN32) && !defined(__clang__))
    __builtin_cpu_init();
    const bool wide = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                      __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
    if (!wide) return VectorTarget::any;
    const bool widest = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
    return widest ? VectorTarget::widest : VectorTarget::wide;
#else
    return VectorTarget::any;
#endif
}

}  // namespace

VectorTarget best_vector_target() {
    static const VectorTarget processor = of_processor();
    const char* bits = std::getenv("RELIEF_VECTOR_BITS");
    if (bits == nullptr) return processor;
    const std::string_view wanted(bits);
    if (wanted == "128") return VectorTarget::any;
    if (wanted == "256") return std::min(processor, VectorTarget::wide);
    return processor;
}

}  // namespace relief::detail
