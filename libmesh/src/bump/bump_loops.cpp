// SPDX-License-Identifier: Apache-2.0
// Vectorized loops from heights to slopes, normals and codes.
//
// Kernels are summed down the columns first, then along the row, with one pass per weight; 3x3
// kernels have loops that apply all weights at once, with the same operations in the same order.
// Heights that are not finite give slopes that are not finite. Square root and division are those
// of IEEE 754, so that every register width gives the same bits.
#include "bump/bump_rows.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "image/normal_coding.h"

namespace relief {
namespace {

/// An unsigned integer of the size of a Real.
template <typename Real>
using BitsOf = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;

/// 1 if the square of a slope exceeds the range in which Real is accurate, or is not finite;
/// otherwise 0.
template <typename Real>
RELIEF_INLINE BitsOf<Real> is_too_steep(Real square) {
    // The bit patterns of positive numbers have the order of the values. NaN and infinity exceed
    // every limit, with or without a sign bit.
    constexpr auto limit =
        std::bit_cast<BitsOf<Real>>(static_cast<Real>(sizeof(Real) == 4 ? 1e30 : 1e300));
    return static_cast<BitsOf<Real>>(std::bit_cast<BitsOf<Real>>(square) > limit);
}

template <FlatCode flat, typename Sample, typename Real>
RELIEF_INLINE Sample encoded(Real component) {
    using Coding = NormalCoding<Sample, Real>;
    if constexpr (std::is_same_v<Sample, float>)
        return Coding::encoded(component);
    else if constexpr (flat == FlatCode::half)
        return Coding::to_half(component);
    else
        return Coding::to_middle(component);
}

/// Interleaves three rows of coordinates to a row of texels.
template <typename Sample>
RELIEF_INLINE void interleave(const Sample* __restrict x, const Sample* __restrict y,
                              const Sample* __restrict z, std::size_t count,
                              Sample* __restrict texels) {
    for (std::size_t i = 0; i < count; ++i) {
        texels[3 * i] = x[i];
        texels[3 * i + 1] = y[i];
        texels[3 * i + 2] = z[i];
    }
}

template <typename Sample, typename Real>
RELIEF_INLINE void sum_rows_3x3(const Sample* __restrict above, const Sample* __restrict here,
                                const Sample* __restrict below, Real own, Real beside,
                                std::size_t count, Real* __restrict smoothed,
                                Real* __restrict rise) {
    for (std::size_t i = 0; i < count; ++i) {
        const Real a = static_cast<Real>(above[i]);
        const Real b = static_cast<Real>(below[i]);
        smoothed[i] = own * static_cast<Real>(here[i]) + beside * (a + b);
        rise[i] = a - b;
    }
}

template <typename Sample, typename Real>
RELIEF_INLINE void multiply_row(const Sample* __restrict row, Real weight, std::size_t count,
                                Real* __restrict sum) {
    for (std::size_t i = 0; i < count; ++i)
        sum[i] = weight * static_cast<Real>(row[i]);
}

template <typename Sample, typename Real>
RELIEF_INLINE void add_sum(const Sample* __restrict a, const Sample* __restrict b, Real weight,
                           std::size_t count, Real* __restrict sum) {
    for (std::size_t i = 0; i < count; ++i)
        sum[i] += weight * (static_cast<Real>(a[i]) + static_cast<Real>(b[i]));
}

template <typename Sample, typename Real>
RELIEF_INLINE void set_difference(const Sample* __restrict from, const Sample* __restrict to,
                                  Real weight, std::size_t count, Real* __restrict sum) {
    for (std::size_t i = 0; i < count; ++i)
        sum[i] = weight * (static_cast<Real>(to[i]) - static_cast<Real>(from[i]));
}

template <typename Sample, typename Real>
RELIEF_INLINE void add_difference(const Sample* __restrict from, const Sample* __restrict to,
                                  Real weight, std::size_t count, Real* __restrict sum) {
    for (std::size_t i = 0; i < count; ++i)
        sum[i] += weight * (static_cast<Real>(to[i]) - static_cast<Real>(from[i]));
}

template <typename Real>
RELIEF_INLINE void multiply(Real scale, std::size_t count, Real* __restrict values) {
    for (std::size_t i = 0; i < count; ++i)
        values[i] *= scale;
}

template <typename Real>
RELIEF_INLINE void sum_columns_3x3(const Real* __restrict smoothed, const Real* __restrict rise,
                                   Real own, Real beside, std::size_t count, Real right_scale,
                                   Real up_scale, Real* __restrict right, Real* __restrict up) {
    for (std::size_t i = 0; i < count; ++i) {
        right[i] = (smoothed[i + 2] - smoothed[i]) * right_scale;
        up[i] = (own * rise[i + 1] + beside * (rise[i] + rise[i + 2])) * up_scale;
    }
}

/// Returns whether a kernel has a single difference of both neighbors with weight 1, and smoothing
/// over three lines.
template <typename Real>
bool is_3x3(const KernelWeights<Real>& weights) {
    return weights.differences.size() == 1 && weights.differences[0].before == -1 &&
           weights.differences[0].weight == 1 && weights.smoothing.size() == 2;
}

template <typename Sample, typename Real>
RELIEF_INLINE void sum_rows(const RowsAround<Sample>& rows, const KernelWeights<Real>& weights,
                            std::size_t first, std::size_t count, Real* smoothed, Real* rise) {
    const auto across = [&](std::ptrdiff_t offset) {
        return rows.across[static_cast<std::size_t>(weights.radius + offset)] + first;
    };
    const auto steep = [&](std::ptrdiff_t offset) {
        return rows.steep[static_cast<std::size_t>(weights.radius + offset)] + first;
    };
    multiply_row(across(0), weights.smoothing[0], count, smoothed);
    for (std::size_t k = 1; k < weights.smoothing.size(); ++k) {
        const auto offset = static_cast<std::ptrdiff_t>(k);
        add_sum(across(-offset), across(offset), weights.smoothing[k], count, smoothed);
    }
    // Rows above come first.
    const auto& differences = weights.differences;
    set_difference(steep(differences[0].after), steep(differences[0].before), differences[0].weight,
                   count, rise);
    for (std::size_t k = 1; k < differences.size(); ++k)
        add_difference(steep(differences[k].after), steep(differences[k].before),
                       differences[k].weight, count, rise);
}

template <typename Real>
RELIEF_INLINE void sum_columns(const KernelWeights<Real>& weights, const Real* smoothed,
                               const Real* rise, std::size_t count, Real right_scale, Real up_scale,
                               Real* right, Real* up) {
    const auto& differences = weights.differences;
    set_difference(smoothed + differences[0].before, smoothed + differences[0].after,
                   differences[0].weight, count, right);
    for (std::size_t k = 1; k < differences.size(); ++k)
        add_difference(smoothed + differences[k].before, smoothed + differences[k].after,
                       differences[k].weight, count, right);
    multiply(right_scale, count, right);
    multiply_row(rise, weights.smoothing[0], count, up);
    for (std::size_t k = 1; k < weights.smoothing.size(); ++k)
        add_sum(rise - k, rise + k, weights.smoothing[k], count, up);
    multiply(up_scale, count, up);
}

template <typename Sample, typename Real>
RELIEF_INLINE void combine_rows_of(const RowsAround<Sample>& rows,
                                   const KernelWeights<Real>& weights, std::size_t first,
                                   std::size_t count, Real* smoothed, Real* rise) {
    if (is_3x3(weights) && rows.steep[0] == rows.across[0] && rows.steep[2] == rows.across[2])
        sum_rows_3x3(rows.steep[0] + first, rows.steep[1] + first, rows.steep[2] + first,
                     weights.smoothing[0], weights.smoothing[1], count, smoothed, rise);
    else
        sum_rows(rows, weights, first, count, smoothed, rise);
}

template <typename Real>
RELIEF_INLINE void combine_columns_of(const KernelWeights<Real>& weights, const Real* smoothed,
                                      const Real* rise, std::size_t count, Real right_scale,
                                      Real up_scale, Real* right, Real* up) {
    if (is_3x3(weights))
        sum_columns_3x3(smoothed - 1, rise - 1, weights.smoothing[0], weights.smoothing[1], count,
                        right_scale, up_scale, right, up);
    else
        sum_columns(weights, smoothed, rise, count, right_scale, up_scale, right, up);
}

template <typename Sample, typename Real>
RELIEF_TARGET_512 void rows_512(const RowsAround<Sample>& rows, const KernelWeights<Real>& weights,
                                std::size_t first, std::size_t count, Real* smoothed, Real* rise) {
    combine_rows_of(rows, weights, first, count, smoothed, rise);
}
template <typename Sample, typename Real>
RELIEF_TARGET_256 void rows_256(const RowsAround<Sample>& rows, const KernelWeights<Real>& weights,
                                std::size_t first, std::size_t count, Real* smoothed, Real* rise) {
    combine_rows_of(rows, weights, first, count, smoothed, rise);
}
template <typename Real>
RELIEF_TARGET_512 void columns_512(const KernelWeights<Real>& weights, const Real* smoothed,
                                   const Real* rise, std::size_t count, Real right_scale,
                                   Real up_scale, Real* right, Real* up) {
    combine_columns_of(weights, smoothed, rise, count, right_scale, up_scale, right, up);
}
template <typename Real>
RELIEF_TARGET_256 void columns_256(const KernelWeights<Real>& weights, const Real* smoothed,
                                   const Real* rise, std::size_t count, Real right_scale,
                                   Real up_scale, Real* right, Real* up) {
    combine_columns_of(weights, smoothed, rise, count, right_scale, up_scale, right, up);
}

template <typename Real>
RELIEF_INLINE bool steep_loop(const Real* __restrict right, const Real* __restrict up,
                              std::size_t count) {
    BitsOf<Real> steep = 0;
    for (std::size_t i = 0; i < count; ++i)
        steep |= is_too_steep(right[i] * right[i] + up[i] * up[i]);
    return steep != 0;
}

/// Returns the inverse of the length of (-right, -up, 1).
template <typename Real>
RELIEF_INLINE Real inverse_length(Real right, Real up) {
    return 1 / std::sqrt(right * right + up * up + 1);
}

template <typename Real>
RELIEF_INLINE void normals_loop(const Real* __restrict right, const Real* __restrict up,
                                std::size_t count, float* __restrict normals) {
    for (std::size_t i = 0; i < count; ++i) {
        const Real scale = inverse_length(right[i], up[i]);
        // Subtracting from zero turns -0 into 0.
        normals[3 * i] = static_cast<float>(0 - right[i] * scale);
        normals[3 * i + 1] = static_cast<float>(0 - up[i] * scale);
        normals[3 * i + 2] = static_cast<float>(scale);
    }
}

/// A coordinate of all texels of a piece.
template <typename Sample>
using Coordinate = std::array<Sample, columns_at_once>;

template <FlatCode flat, typename Sample, typename Real>
RELIEF_INLINE void coordinates_loop(const Real* __restrict right, const Real* __restrict up,
                                    std::size_t count, Real green, Sample* __restrict x,
                                    Sample* __restrict y, Sample* __restrict z) {
    for (std::size_t i = 0; i < count; ++i) {
        const Real scale = inverse_length(right[i], up[i]);
        x[i] = encoded<flat, Sample>(0 - right[i] * scale);
        y[i] = encoded<flat, Sample>(0 - green * up[i] * scale);
        z[i] = encoded<flat, Sample>(scale);
    }
}

template <FlatCode flat, typename Sample, typename Real>
RELIEF_INLINE void codes_of(const Real* right, const Real* up, std::size_t count, Real green,
                            Sample* codes) {
    alignas(64) Coordinate<Sample> x, y, z;
    coordinates_loop<flat>(right, up, count, green, x.data(), y.data(), z.data());
    interleave(x.data(), y.data(), z.data(), count, codes);
}

template <typename Real>
RELIEF_TARGET_512 bool steep_512(const Real* right, const Real* up, std::size_t count) {
    return steep_loop(right, up, count);
}
template <typename Real>
RELIEF_TARGET_256 bool steep_256(const Real* right, const Real* up, std::size_t count) {
    return steep_loop(right, up, count);
}
template <typename Real>
RELIEF_TARGET_512 void normals_512(const Real* right, const Real* up, std::size_t count,
                                   float* normals) {
    normals_loop(right, up, count, normals);
}
template <typename Real>
RELIEF_TARGET_256 void normals_256(const Real* right, const Real* up, std::size_t count,
                                   float* normals) {
    normals_loop(right, up, count, normals);
}
template <FlatCode flat, typename Sample, typename Real>
RELIEF_TARGET_512 void codes_512(const Real* right, const Real* up, std::size_t count, Real green,
                                 Sample* codes) {
    codes_of<flat>(right, up, count, green, codes);
}
template <FlatCode flat, typename Sample, typename Real>
RELIEF_TARGET_256 void codes_256(const Real* right, const Real* up, std::size_t count, Real green,
                                 Sample* codes) {
    codes_of<flat>(right, up, count, green, codes);
}
template <FlatCode flat, typename Sample, typename Real>
[[gnu::noinline]] void codes_any(const Real* right, const Real* up, std::size_t count, Real green,
                                 Sample* codes) {
    codes_of<flat>(right, up, count, green, codes);
}

template <FlatCode flat, typename Sample, typename Real>
void codes_with(VectorTarget target, const Real* right, const Real* up, std::size_t count,
                Real green, Sample* codes) {
    switch (target) {
        case VectorTarget::widest:
            return codes_512<flat>(right, up, count, green, codes);
        case VectorTarget::wide:
            return codes_256<flat>(right, up, count, green, codes);
        case VectorTarget::any:
            return codes_any<flat>(right, up, count, green, codes);
    }
}

/// The products of weights and scales, with the sign of green.
struct Scaled3x3 {
    float own_right, beside_right, own_up, beside_up;
};

/// Encodes the negative of a component that is scaled to code steps. Rounding is symmetric, so the
/// sign can be applied last.
template <FlatCode flat, typename Code>
RELIEF_INLINE Code code_of_negative(float steps) {
    if constexpr (flat == FlatCode::half)
        return NormalCoding<Code, float>::from_half_steps(-steps);
    else
        return NormalCoding<Code, float>::from_middle_steps(-steps);
}

template <FlatCode flat, typename Code>
RELIEF_INLINE bool coordinates_3x3(const float* __restrict above, const float* __restrict here,
                                   const float* __restrict below, const Scaled3x3& weights,
                                   std::size_t count, Code* __restrict x, Code* __restrict y,
                                   Code* __restrict z) {
    const Scaled3x3 w = weights;
    constexpr float steps = NormalCoding<Code, float>::steps(flat);
    std::uint32_t too_steep = 0;
    for (std::size_t i = 0; i < count; ++i) {
        // The corners contribute the sum and the difference of the diagonals.
        const float rising = above[i + 2] - below[i];
        const float falling = below[i + 2] - above[i];
        const float right =
            w.own_right * (here[i + 2] - here[i]) + w.beside_right * (rising + falling);
        const float up =
            w.own_up * (above[i + 1] - below[i + 1]) + w.beside_up * (rising - falling);
        const float square = right * right + up * up;
        too_steep |= is_too_steep(square);
        const float scale = steps / std::sqrt(square + 1);
        x[i] = code_of_negative<flat, Code>(right * scale);
        y[i] = code_of_negative<flat, Code>(up * scale);
        z[i] = code_of_negative<flat, Code>(-scale);
    }
    return too_steep != 0;
}

/// Prefetches memory. The processor does not predict accesses across the ends of rows and pages, or
/// after many stores.
template <int for_writing>
RELIEF_INLINE void prefetch(const void* begin, std::size_t bytes) {
    for (std::size_t at = 0; at < bytes; at += 64)
        __builtin_prefetch(static_cast<const char*>(begin) + at, for_writing);
}

/// The number of texels between prefetches.
constexpr std::size_t texels_per_block = 256;

/// The coordinates of a block, by component.
template <typename Code>
struct Coordinates {
    alignas(64) std::array<Code, texels_per_block> x, y, z;
};

/// Heights to prefetch.
struct NextHeights {
    const char* begin;
    std::size_t size;  ///< Bytes per texel.
};

template <FlatCode flat, typename Code>
RELIEF_INLINE bool blocks_3x3(const std::array<const float*, 3>& rows, const Scaled3x3& weights,
                              std::size_t count, Code* codes, const NextHeights& next_heights) {
    Coordinates<Code> at;
    bool too_steep = false;
    for (std::size_t first = 0; first < count; first += texels_per_block) {
        const std::size_t size = std::min(texels_per_block, count - first);
        Code* const to = codes + 3 * first;
        prefetch<1>(to + 3 * size, 3 * size * sizeof(Code));
        prefetch<0>(next_heights.begin + first * next_heights.size, size * next_heights.size);
        too_steep |= coordinates_3x3<flat>(rows[0] + first, rows[1] + first, rows[2] + first,
                                           weights, size, at.x.data(), at.y.data(), at.z.data());
        interleave(at.x.data(), at.y.data(), at.z.data(), size, to);
    }
    return too_steep;
}

template <FlatCode flat, typename Code>
RELIEF_TARGET_512 bool codes_3x3_512(const std::array<const float*, 3>& rows,
                                     const Scaled3x3& weights, std::size_t count, Code* codes,
                                     const NextHeights& next_heights) {
    return blocks_3x3<flat>(rows, weights, count, codes, next_heights);
}
template <FlatCode flat, typename Code>
RELIEF_TARGET_256 bool codes_3x3_256(const std::array<const float*, 3>& rows,
                                     const Scaled3x3& weights, std::size_t count, Code* codes,
                                     const NextHeights& next_heights) {
    return blocks_3x3<flat>(rows, weights, count, codes, next_heights);
}
template <FlatCode flat, typename Code>
[[gnu::noinline]] bool codes_3x3_any(const std::array<const float*, 3>& rows,
                                     const Scaled3x3& weights, std::size_t count, Code* codes,
                                     const NextHeights& next_heights) {
    return blocks_3x3<flat>(rows, weights, count, codes, next_heights);
}

template <FlatCode flat, typename Code>
bool codes_3x3_with(VectorTarget target, const std::array<const float*, 3>& rows,
                    const Scaled3x3& weights, std::size_t count, Code* codes,
                    const NextHeights& next_heights) {
    switch (target) {
        case VectorTarget::widest:
            return codes_3x3_512<flat>(rows, weights, count, codes, next_heights);
        case VectorTarget::wide:
            return codes_3x3_256<flat>(rows, weights, count, codes, next_heights);
        case VectorTarget::any:
            break;
    }
    return codes_3x3_any<flat>(rows, weights, count, codes, next_heights);
}

}  // namespace

template <typename Real>
KernelWeights<Real>::KernelWeights(const GradientKernel& kernel) : radius(kernel.radius) {
    for (const HeightDifference& difference : kernel.differences)
        differences.push_back(
            {difference.before, difference.after, static_cast<Real>(difference.weight)});
    for (const double weight : kernel.smoothing)
        smoothing.push_back(static_cast<Real>(weight));
}

template <typename Sample, typename Real>
void combine_rows(VectorTarget target, const RowsAround<Sample>& rows,
                  const KernelWeights<Real>& weights, std::size_t first, std::size_t count,
                  Real* smoothed, Real* rise) {
    switch (target) {
        case VectorTarget::widest:
            return rows_512(rows, weights, first, count, smoothed, rise);
        case VectorTarget::wide:
            return rows_256(rows, weights, first, count, smoothed, rise);
        case VectorTarget::any:
            return combine_rows_of(rows, weights, first, count, smoothed, rise);
    }
}

template <typename Real>
void combine_columns(VectorTarget target, const KernelWeights<Real>& weights, const Real* smoothed,
                     const Real* rise, std::size_t count, Real right_scale, Real up_scale,
                     Real* right, Real* up) {
    switch (target) {
        case VectorTarget::widest:
            return columns_512(weights, smoothed, rise, count, right_scale, up_scale, right, up);
        case VectorTarget::wide:
            return columns_256(weights, smoothed, rise, count, right_scale, up_scale, right, up);
        case VectorTarget::any:
            return combine_columns_of(weights, smoothed, rise, count, right_scale, up_scale, right,
                                      up);
    }
}

template struct KernelWeights<float>;
template struct KernelWeights<double>;

#define RELIEF_INSTANTIATE(Sample, Real)                                                    \
    template void combine_rows(VectorTarget, const RowsAround<Sample>&,                     \
                               const KernelWeights<Real>&, std::size_t, std::size_t, Real*, \
                               Real*);
RELIEF_INSTANTIATE(std::uint8_t, float)
RELIEF_INSTANTIATE(std::uint8_t, double)
RELIEF_INSTANTIATE(std::uint16_t, float)
RELIEF_INSTANTIATE(std::uint16_t, double)
RELIEF_INSTANTIATE(float, float)
RELIEF_INSTANTIATE(float, double)
RELIEF_INSTANTIATE(double, double)
#undef RELIEF_INSTANTIATE

template void combine_columns(VectorTarget, const KernelWeights<float>&, const float*, const float*,
                              std::size_t, float, float, float*, float*);
template void combine_columns(VectorTarget, const KernelWeights<double>&, const double*,
                              const double*, std::size_t, double, double, double*, double*);

template <typename Real>
bool any_too_steep(VectorTarget target, const Real* right, const Real* up, std::size_t count) {
    switch (target) {
        case VectorTarget::widest:
            return steep_512(right, up, count);
        case VectorTarget::wide:
            return steep_256(right, up, count);
        case VectorTarget::any:
            break;
    }
    return steep_loop(right, up, count);
}

template <typename Real>
void store_normals(VectorTarget target, const Real* right, const Real* up, std::size_t count,
                   float* normals) {
    switch (target) {
        case VectorTarget::widest:
            return normals_512(right, up, count, normals);
        case VectorTarget::wide:
            return normals_256(right, up, count, normals);
        case VectorTarget::any:
            return normals_loop(right, up, count, normals);
    }
}

template <typename Sample, typename Real>
void store_codes(VectorTarget target, const Real* right, const Real* up, std::size_t count,
                 const NormalMapFormat& format, Sample* codes) {
    const Real green = format.green == Green::up ? 1 : -1;
    if (format.flat == FlatCode::half)
        codes_with<FlatCode::half>(target, right, up, count, green, codes);
    else
        codes_with<FlatCode::middle>(target, right, up, count, green, codes);
}

template <typename Sample, typename Real>
void store_dithered_codes(const Real* right, const Real* up, std::size_t count,
                          const NormalMapFormat& format, std::size_t first,
                          const DitherRow& thresholds, Sample* codes) {
    const NormalCoding<Sample> coding{format.flat};
    const double green = format.green == Green::up ? 1 : -1;
    for (std::size_t i = 0; i < count; ++i) {
        const double x = right[i];
        const double y = up[i];
        const double scale = inverse_length(x, y);
        codes[3 * i] = coding.dithered(-x * scale, thresholds.at(first + i, 0));
        codes[3 * i + 1] = coding.dithered(-y * green * scale, thresholds.at(first + i, 1));
        codes[3 * i + 2] = coding.dithered(scale, thresholds.at(first + i, 2));
    }
}

#define RELIEF_INSTANTIATE(Real)                                                              \
    template bool any_too_steep(VectorTarget, const Real*, const Real*, std::size_t);         \
    template void store_normals(VectorTarget, const Real*, const Real*, std::size_t, float*); \
    template void store_codes(VectorTarget, const Real*, const Real*, std::size_t,            \
                              const NormalMapFormat&, std::uint8_t*);                         \
    template void store_codes(VectorTarget, const Real*, const Real*, std::size_t,            \
                              const NormalMapFormat&, std::uint16_t*);                        \
    template void store_codes(VectorTarget, const Real*, const Real*, std::size_t,            \
                              const NormalMapFormat&, float*);                                \
    template void store_dithered_codes(const Real*, const Real*, std::size_t,                 \
                                       const NormalMapFormat&, std::size_t, const DitherRow&, \
                                       std::uint8_t*);                                        \
    template void store_dithered_codes(const Real*, const Real*, std::size_t,                 \
                                       const NormalMapFormat&, std::size_t, const DitherRow&, \
                                       std::uint16_t*);
RELIEF_INSTANTIATE(float)
RELIEF_INSTANTIATE(double)
#undef RELIEF_INSTANTIATE

template <typename Code>
bool codes_3x3(VectorTarget target, const std::array<const float*, 3>& rows,
               const Weights3x3& weights, std::size_t count, const NormalMapFormat& format,
               Code* codes, const void* next, std::size_t next_size) {
    const NextHeights next_heights{static_cast<const char*>(next), next_size};
    const float up_scale = format.green == Green::up ? weights.up_scale : -weights.up_scale;
    const Scaled3x3 scaled{weights.own * weights.right_scale, weights.beside * weights.right_scale,
                           weights.own * up_scale, weights.beside * up_scale};
    if (format.flat == FlatCode::half)
        return codes_3x3_with<FlatCode::half>(target, rows, scaled, count, codes, next_heights);
    return codes_3x3_with<FlatCode::middle>(target, rows, scaled, count, codes, next_heights);
}

template bool codes_3x3(VectorTarget, const std::array<const float*, 3>&, const Weights3x3&,
                        std::size_t, const NormalMapFormat&, std::uint8_t*, const void*,
                        std::size_t);
template bool codes_3x3(VectorTarget, const std::array<const float*, 3>&, const Weights3x3&,
                        std::size_t, const NormalMapFormat&, std::uint16_t*, const void*,
                        std::size_t);

}  // namespace relief
