// SPDX-License-Identifier: Apache-2.0
/// \file
/// The common case in one loop: kernels of 3x3 in float, heights to codes, nothing stored in
/// between. Sums are in another order than in slope_loops.h, with fewer operations; the bits are
/// the same on every processor here too.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "image/bump/bump_rows.h"
#include "image/bump/slope_loops.h"
#include "vector_targets.h"

namespace relief {

/// A kernel of one difference over two texels, and smoothing over three lines at most, scaled.
struct Weights3x3 {
    float own, beside;  ///< Of the line itself, and of those beside it.
    float right_scale, up_scale;
};

/// These of a kernel, if it is such a one.
std::optional<Weights3x3> weights_3x3(const KernelWeights<float>& weights, float right_scale,
                                      float up_scale);

/// Rows of heights as floats, with one more at each end by the wrap rule: three at a time, each
/// read once.
template <typename Sample>
class PaddedRows {
  public:
    PaddedRows(const HeightRows& heights, Wrap wrap);

    /// The rows before, at and behind a row (by `wrap` where they lie outside), from the column
    /// before the first on. Valid until the next call.
    std::array<const float*, 3> around(int row, Wrap wrap);

  private:
    struct Slot {
        int row = -1;
        std::vector<float> samples;
    };
    Slot& load(int row, const std::array<int, 3>& needed);

    const HeightRows& heights_;
    Wrap wrap_;
    std::array<Slot, 3> slots_;
};

/// Codes of at most `columns_at_once` texels.
///
/// \param rows  point at the column before the first
/// \param next  heights that will be wanted soon, `next_size` bytes for each texel: only asked for
///              in advance, so it matters to nothing but time whether they are there
/// \return whether a slope is too steep for float (any_too_steep): then the codes are of no meaning
template <typename Code>
bool codes_3x3(VectorTarget target, const std::array<const float*, 3>& rows,
               const Weights3x3& weights, std::size_t count, const NormalMapFormat& format,
               Code* codes, const void* next, std::size_t next_size);

}  // namespace relief
