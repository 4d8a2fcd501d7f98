// SPDX-License-Identifier: Apache-2.0
// Nothing throws. Tests: tests/mesh/bump/tile_loops_test.cpp.
#include "bump/tile_loops.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace relief::detail {
namespace {

template <std::size_t weight_count>
RELIEF_INLINE void filter_with(const double* __restrict from, const double* __restrict weights,
                               std::ptrdiff_t offset, std::size_t count, double* __restrict to) {
    for (std::size_t i = 0; i < count; ++i) {
        const double* const center = from + i;
        double sum = weights[0] * center[0] + weights[1] * (center[-offset] + center[offset]);
        if constexpr (weight_count > 2)
            sum += weights[2] * (center[-2 * offset] + center[2 * offset]);
        if constexpr (weight_count > 3)
            sum += weights[3] * (center[-3 * offset] + center[3 * offset]);
        if constexpr (weight_count > 4)
            sum += weights[4] * (center[-4 * offset] + center[4 * offset]);
        to[i] = sum;
    }
}

RELIEF_INLINE void symmetric_filter_loop(const double* from, std::span<const double> weights,
                                         std::ptrdiff_t offset, std::size_t count, double* to) {
    if (weights.size() == 2)
        filter_with<2>(from, weights.data(), offset, count, to);
    else if (weights.size() == 3)
        filter_with<3>(from, weights.data(), offset, count, to);
    else
        filter_with<5>(from, weights.data(), offset, count, to);
}

RELIEF_INLINE void second_difference_loop(const double* __restrict from, std::ptrdiff_t offset,
                                          std::size_t count, double* __restrict to) {
    for (std::size_t i = 0; i < count; ++i)
        to[i] = -2.0 * from[static_cast<std::ptrdiff_t>(i) + offset] +
                (from[i] + from[static_cast<std::ptrdiff_t>(i) + 2 * offset]);
}

RELIEF_INLINE double difference_at(const double* line, std::ptrdiff_t i) {
    return std::abs(line[i + 1] - line[i]);
}

RELIEF_INLINE bool find_step_edges_loop(const double* __restrict line, std::size_t count,
                                        double min_height, double times,
                                        std::int64_t* __restrict edges) {
    std::int64_t any = 0;
    for (std::size_t n = 0; n < count; ++n) {
        const auto i = static_cast<std::ptrdiff_t>(n);
        const double step = difference_at(line, i);
        const double before =
            std::max(std::max(difference_at(line, i - 1), difference_at(line, i - 2)),
                     std::max(difference_at(line, i - 3), difference_at(line, i - 4)));
        const double after =
            std::max(std::max(difference_at(line, i + 1), difference_at(line, i + 2)),
                     std::max(difference_at(line, i + 3), difference_at(line, i + 4)));
        const std::int64_t is_high = step >= min_height ? 1 : 0;
        const std::int64_t is_step = step > 0.0 ? 1 : 0;
        const std::int64_t is_alone = step > times * std::max(before, after) ? 1 : 0;
        edges[n] = is_high & is_step & is_alone;
        any |= edges[n];
    }
    return any != 0;
}

RELIEF_INLINE void central_slopes_loop(const double* __restrict line,
                                       const double* __restrict weights, std::size_t count,
                                       double* __restrict slopes) {
    for (std::size_t n = 0; n < count; ++n) {
        const double* const center = line + n;
        double slope = weights[1] * (center[1] - center[-1]);
        slope += weights[2] * (center[2] - center[-2]);
        slope += weights[3] * (center[3] - center[-3]);
        slope += weights[4] * (center[4] - center[-4]);
        slope += weights[5] * (center[5] - center[-5]);
        slope += weights[6] * (center[6] - center[-6]);
        slopes[n] = slope;
    }
}

RELIEF_INLINE void heights_above_neighbors_loop(const double* __restrict above,
                                                const double* __restrict here,
                                                const double* __restrict below, std::size_t count,
                                                double* __restrict heights) {
    for (std::size_t n = 0; n < count; ++n) {
        const auto i = static_cast<std::ptrdiff_t>(n);
        const double a = here[i] - 0.5 * (here[i + 1] + here[i - 1]);
        const double b = here[i] - 0.5 * (below[i + 1] + above[i - 1]);
        const double c = here[i] - 0.5 * (below[i] + above[i]);
        const double d = here[i] - 0.5 * (below[i - 1] + above[i + 1]);
        const double second = std::max(std::min(a, b), std::min(c, d));
        const double third = std::min(std::max(a, b), std::max(c, d));
        heights[i] = 0.5 * (second + third);
    }
}

RELIEF_INLINE void unit_normals_loop(const double* __restrict right, const double* __restrict down,
                                     std::size_t count, const NormalRows<double>& normals) {
    double* const __restrict x = normals.x;
    double* const __restrict y = normals.y;
    double* const __restrict z = normals.z;
    for (std::size_t i = 0; i < count; ++i) {
        const double inverse = 1.0 / std::sqrt(right[i] * right[i] + down[i] * down[i] + 1.0);
        x[i] = -right[i] * inverse;
        y[i] = down[i] * inverse;
        z[i] = inverse;
    }
}

RELIEF_INLINE void angles_between_loop(const double* __restrict right, const double* __restrict up,
                                       const NormalRows<const double>& exact, std::size_t count,
                                       double* __restrict angles, double* __restrict squares) {
    const double* const __restrict exact_x = exact.x;
    const double* const __restrict exact_y = exact.y;
    const double* const __restrict exact_z = exact.z;
    for (std::size_t i = 0; i < count; ++i) {
        const double inverse = 1.0 / std::sqrt(right[i] * right[i] + up[i] * up[i] + 1.0);
        const double x = static_cast<double>(static_cast<float>(-right[i] * inverse)) - exact_x[i];
        const double y = static_cast<double>(static_cast<float>(-up[i] * inverse)) - exact_y[i];
        const double z = static_cast<double>(static_cast<float>(inverse)) - exact_z[i];
        const double square = x * x + y * y + z * z;
        const double angle_per_chord = 1.0 + square * (1.0 / 24.0 + square * (3.0 / 640.0));
        squares[i] = square * angle_per_chord * angle_per_chord;
        angles[i] = std::sqrt(square) * angle_per_chord;
    }
}

RELIEF_INLINE std::int32_t sum_of_quarters(std::uint64_t bits) {
    return static_cast<std::int32_t>((bits & 0xffff) + (bits >> 16 & 0xffff) +
                                     (bits >> 32 & 0xffff) + (bits >> 48));
}

RELIEF_INLINE void random_normals_loop(std::uint32_t seed, std::size_t count,
                                       double* __restrict numbers) {
    // The mean of the sum, and its standard deviation.
    constexpr double mean = 12.0 * 32767.5;
    constexpr double per_deviation = 1.0 / 65536.0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint64_t state = seed + split_mix_step * (3 * i + 1);
        const std::int32_t sum = sum_of_quarters(mixed_bits(state)) +
                                 sum_of_quarters(mixed_bits(state + split_mix_step)) +
                                 sum_of_quarters(mixed_bits(state + 2 * split_mix_step));
        numbers[i] = (static_cast<double>(sum) - mean) * per_deviation;
    }
}

RELIEF_INLINE void round_to_steps_loop(double step, double shift, std::size_t count,
                                       double* __restrict values) {
    for (std::size_t i = 0; i < count; ++i)
        values[i] = step * std::floor((values[i] + shift) / step + 0.5) - shift;
}

}  // namespace

// Defines a function that calls its loop, compiled for the target.
#define RELIEF_DISPATCH(result, loop, parameters, arguments) \
    namespace {                                              \
    RELIEF_TARGET_512 result loop##_512 parameters {         \
        return loop##_loop arguments;                        \
    }                                                        \
    RELIEF_TARGET_256 result loop##_256 parameters {         \
        return loop##_loop arguments;                        \
    }                                                        \
    [[gnu::noinline]] result loop##_any parameters {         \
        return loop##_loop arguments;                        \
    }                                                        \
    }
#define RELIEF_CALL(loop, arguments)     \
    switch (target) {                    \
        case VectorTarget::widest:       \
            return loop##_512 arguments; \
        case VectorTarget::wide:         \
            return loop##_256 arguments; \
        case VectorTarget::any:          \
            break;                       \
    }                                    \
    return loop##_any arguments

RELIEF_DISPATCH(void, symmetric_filter,
                (const double* from, std::span<const double> weights, std::ptrdiff_t offset,
                 std::size_t count, double* to),
                (from, weights, offset, count, to))
RELIEF_DISPATCH(void, second_difference,
                (const double* from, std::ptrdiff_t offset, std::size_t count, double* to),
                (from, offset, count, to))
RELIEF_DISPATCH(bool, find_step_edges,
                (const double* line, std::size_t count, double min_height, double times,
                 std::int64_t* edges),
                (line, count, min_height, times, edges))
RELIEF_DISPATCH(void, central_slopes,
                (const double* line, const double* weights, std::size_t count, double* slopes),
                (line, weights, count, slopes))
RELIEF_DISPATCH(void, heights_above_neighbors,
                (const double* above, const double* here, const double* below, std::size_t count,
                 double* heights),
                (above, here, below, count, heights))
RELIEF_DISPATCH(void, unit_normals,
                (const double* right, const double* down, std::size_t count,
                 const NormalRows<double>& normals),
                (right, down, count, normals))
RELIEF_DISPATCH(void, angles_between,
                (const double* right, const double* up, const NormalRows<const double>& exact,
                 std::size_t count, double* angles, double* squares),
                (right, up, exact, count, angles, squares))
RELIEF_DISPATCH(void, random_normals, (std::uint32_t seed, std::size_t count, double* numbers),
                (seed, count, numbers))
RELIEF_DISPATCH(void, round_to_steps,
                (double step, double shift, std::size_t count, double* values),
                (step, shift, count, values))

void symmetric_filter(VectorTarget target, const double* from, std::span<const double> weights,
                      std::ptrdiff_t offset, std::size_t count, double* to) {
    RELIEF_CALL(symmetric_filter, (from, weights, offset, count, to));
}

void second_difference(VectorTarget target, const double* from, std::ptrdiff_t offset,
                       std::size_t count, double* to) {
    RELIEF_CALL(second_difference, (from, offset, count, to));
}

bool find_step_edges(VectorTarget target, const double* line, std::size_t count, double min_height,
                     double times, std::int64_t* edges) {
    RELIEF_CALL(find_step_edges, (line, count, min_height, times, edges));
}

void central_slopes(VectorTarget target, const double* line, const double* weights,
                    std::size_t count, double* slopes) {
    RELIEF_CALL(central_slopes, (line, weights, count, slopes));
}

void heights_above_neighbors(VectorTarget target, const double* above, const double* here,
                             const double* below, std::size_t count, double* heights) {
    RELIEF_CALL(heights_above_neighbors, (above, here, below, count, heights));
}

void unit_normals(VectorTarget target, const double* right, const double* down, std::size_t count,
                  const NormalRows<double>& normals) {
    RELIEF_CALL(unit_normals, (right, down, count, normals));
}

void angles_between(VectorTarget target, const double* right, const double* up,
                    const NormalRows<const double>& exact, std::size_t count, double* angles,
                    double* squares) {
    RELIEF_CALL(angles_between, (right, up, exact, count, angles, squares));
}

void random_normals(VectorTarget target, std::uint32_t seed, std::size_t count, double* numbers) {
    RELIEF_CALL(random_normals, (seed, count, numbers));
}

void round_to_steps(VectorTarget target, double step, double shift, std::size_t count,
                    double* values) {
    RELIEF_CALL(round_to_steps, (step, shift, count, values));
}

#undef RELIEF_DISPATCH
#undef RELIEF_CALL

}  // namespace relief::detail
