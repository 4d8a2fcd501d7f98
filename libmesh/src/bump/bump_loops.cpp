// SPDX-License-Identifier: Apache-2.0
// Vectorized loops from heights to slopes.
//
// Kernels are summed down the columns first, then along the row, with one pass per weight; 3x3
// kernels have loops that apply all weights at once, with the same operations in the same order.
// Heights that are not finite give slopes that are not finite.
#include "bump/bump_rows.h"

#include <cstddef>
#include <cstdint>

namespace relief::detail {
namespace {

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

}  // namespace relief::detail
