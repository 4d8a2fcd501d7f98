// SPDX-License-Identifier: Apache-2.0
/// \file
/// The two passes of a separable kernel over a piece of a row, on whole vector registers. Heights
/// in units of their own; slopes to the right and upwards. The same bits on every processor: each
/// element is the same sums in the same order.
#pragma once

#include <cstddef>
#include <vector>

#include "relief/mesh/gradient_kernel.h"
#include "vector_targets.h"

namespace relief {

/// So many columns are worked on at once: what lies in between stays in the first-level cache.
inline constexpr std::size_t columns_at_once = 1024;

/// A kernel's weights in the arithmetic of its sums, without its divisor.
template <typename Real>
struct KernelWeights {
    explicit KernelWeights(const GradientKernel& kernel);

    struct Difference {
        std::ptrdiff_t before, after;
        Real weight;
    };
    std::vector<Difference> differences;
    std::vector<Real> smoothing;
    std::ptrdiff_t radius;
};

/// The rows around one row: the row k below stands at index radius + k.
template <typename Sample>
struct RowsAround {
    std::vector<const Sample*> steep;   ///< For differences from row to row.
    std::vector<const Sample*> across;  ///< For smoothing over rows.
};

/// Columns [first, first + count) of the rows brought to one row each.
///
/// \param smoothed  their smoothed sum
/// \param rise      their differences, positive where heights grow upwards in the image
template <typename Sample, typename Real>
void combine_rows(VectorTarget target, const RowsAround<Sample>& rows,
                  const KernelWeights<Real>& weights, std::size_t first, std::size_t count,
                  Real* smoothed, Real* rise);

/// Slopes from what combine_rows has made of the columns from `radius` before to `radius` behind.
///
/// \param smoothed, rise  point at the first column that a slope is wanted of
/// \param right_scale, up_scale  what the sums are multiplied by
template <typename Real>
void combine_columns(VectorTarget target, const KernelWeights<Real>& weights, const Real* smoothed,
                     const Real* rise, std::size_t count, Real right_scale, Real up_scale,
                     Real* right, Real* up);

}  // namespace relief
