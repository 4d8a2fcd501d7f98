// SPDX-License-Identifier: Apache-2.0
/// \file
/// Rows of a normal map from rows of heights, which may be in an image or in a moving window of a
/// file; and the vectorized loops over pieces of a row: the two passes of a separable kernel,
/// normals from slopes, codes from normals, and a direct loop from heights to codes for 3x3
/// kernels. Slopes are to the right and upwards. Every processor gives the same bits, because each
/// element is the same sums in the same order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "image/dither_tile.h"
#include "portable_math.h"
#include "relief/export.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/normal_map.h"

namespace RELIEF_API relief {
namespace detail {

/// The grain size of parallel loops over rows.
inline constexpr std::size_t bump_texels_per_piece = 1 << 16;

/// \throws InvalidInput if the strength, the texel size or the radius is out of range
void check_bump(const BumpOptions& options);

/// Access to a height map by rows.
struct HeightRows {
    int width = 0;
    int height = 0;
    int bits = 32;  ///< 8 or 16: integers for value / 255 and value / 65535; 32: float.
    /// Returns the first sample of a row in [0, height). It is called from several threads, for
    /// rows within the radius of the kernel, after wrapping.
    std::function<const void*(int row)> row;
};

/// The kind of result.
enum class BumpResult {
    slopes,   ///< Two floats: dh/dx to the right, dh/dy upwards.
    normals,  ///< Three floats, unit.
    codes,    ///< Three samples in a NormalMapFormat.
};

struct BumpTarget {
    BumpResult result = BumpResult::normals;
    NormalMapFormat format{};
    /// Returns the address of the first sample of a row.
    std::function<void*(int row)> row;
};

/// Computes rows [first, last) on the calling thread.
///
/// \param options  without unset fields; see resolve_options()
/// \return false if a height that contributes is not finite, which makes the result invalid
bool make_bump_rows(const HeightRows& heights, const BumpOptions& options, const BumpTarget& target,
                    int first, int last);

/// The number of columns of a piece, whose intermediate values fit the first-level cache.
inline constexpr std::size_t columns_at_once = 1024;

/// The weights of a kernel in the precision of its sums, without the divisor.
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

/// The rows around a row; the row k below it has index radius + k.
template <typename Sample>
struct RowsAround {
    std::vector<const Sample*> steep;   ///< For differences between rows.
    std::vector<const Sample*> across;  ///< For smoothing across rows.
};

/// Combines columns [first, first + count) of the rows.
///
/// \param smoothed  gets the weighted sums
/// \param rise      gets the differences, positive if heights increase upwards in the image
template <typename Sample, typename Real>
void combine_rows(VectorTarget target, const RowsAround<Sample>& rows,
                  const KernelWeights<Real>& weights, std::size_t first, std::size_t count,
                  Real* smoothed, Real* rise);

/// Slopes from the output of combine_rows(), which must extend by `radius` columns on both sides.
///
/// \param smoothed, rise  the first column of the slopes
/// \param right_scale, up_scale  the factors of the sums
template <typename Real>
void combine_columns(VectorTarget target, const KernelWeights<Real>& weights, const Real* smoothed,
                     const Real* rise, std::size_t count, Real right_scale, Real up_scale,
                     Real* right, Real* up);

/// Returns whether the square of any slope exceeds the range in which Real is accurate, 1e30 for
/// float and 1e300 for double, or is not finite.
template <typename Real>
bool any_too_steep(VectorTarget target, const Real* right, const Real* up, std::size_t count);

/// Stores normalize(-right, -up, 1) as three floats per texel. Slopes of zero give exactly (0,0,1).
template <typename Real>
void store_normals(VectorTarget target, const Real* right, const Real* up, std::size_t count,
                   float* normals);

/// Stores normals as codes or scaled floats. Sample is the type of format.bits.
template <typename Sample, typename Real>
void store_codes(VectorTarget target, const Real* right, const Real* up, std::size_t count,
                 const NormalMapFormat& format, Sample* codes);

/// The same with dithering, for texels of a row from column `first` on. It computes in double,
/// which resolves fractions of 16-bit codes.
template <typename Sample, typename Real>
void store_dithered_codes(const Real* right, const Real* up, std::size_t count,
                          const NormalMapFormat& format, std::size_t first,
                          const DitherRow& thresholds, Sample* codes);

/// A kernel with one difference over two texels and smoothing over at most three lines, with its
/// scales.
struct Weights3x3 {
    float own, beside;  ///< Of the center line and of its neighbors.
    float right_scale, up_scale;
};

/// The heights around a row of codes.
struct Rows3x3 {
    std::array<const float*, 3> rows{};    ///< Above, at and below it.
    std::array<float, 3> left{}, right{};  ///< One column beyond the borders.
    /// Heights to prefetch, `next_size` bytes per texel; they need not be valid.
    const void* next = nullptr;
    std::size_t next_size = 0;
};

/// Computes a row of codes directly from heights, in float. The order of the sums differs from
/// combine_rows(), with fewer operations.
///
/// \return whether a slope is too steep for float (any_too_steep()), which makes the row invalid
template <typename Code>
bool codes_3x3(VectorTarget target, const Rows3x3& rows, const Weights3x3& weights,
               std::size_t width, const NormalMapFormat& format, Code* codes);

}  // namespace detail
}  // namespace relief
