// SPDX-License-Identifier: Apache-2.0
/// \file
/// A piece of a row of slopes into what is to be stored, on whole vector registers. Slopes to the
/// right and upwards, in tangent space. The same bits on every processor.
#pragma once

#include <cstddef>

#include "image/dither_tile.h"
#include "relief/mesh/normal_map.h"
#include "vector_targets.h"

namespace relief {

/// Whether the square of any slope leaves the range that Real can be trusted in: 1e30 for float,
/// 1e300 for double; also where one is not finite.
template <typename Real>
bool any_too_steep(VectorTarget target, const Real* right, const Real* up, std::size_t count);

/// normalize(-right, -up, 1) as three floats a texel; flat is (0,0,1) to the bit.
template <typename Real>
void store_normals(VectorTarget target, const Real* right, const Real* up, std::size_t count,
                   float* normals);

/// The same as codes or scaled floats; at most `columns_at_once` texels. Sample is that of
/// format.bits.
template <typename Sample, typename Real>
void store_codes(VectorTarget target, const Real* right, const Real* up, std::size_t count,
                 const NormalMapFormat& format, Sample* codes);

/// The same dithered: texels of a row from column `first` on. In double, which tells fractions of
/// 16-bit codes.
template <typename Sample, typename Real>
void store_dithered_codes(const Real* right, const Real* up, std::size_t count,
                          const NormalMapFormat& format, std::size_t first,
                          const DitherRow& thresholds, Sample* codes);

}  // namespace relief
