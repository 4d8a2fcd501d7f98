// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the loops that store normals have in common, to be inlined into each.
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "image/normal_coding.h"
#include "vector_targets.h"

namespace relief {

/// An unsigned integer of the size of a Real.
template <typename Real>
using BitsOf = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;

/// 1 where the square of a slope leaves the range that Real can be trusted in, also where it is not
/// finite; else 0.
template <typename Real>
RELIEF_INLINE BitsOf<Real> is_too_steep(Real square) {
    // On the bits, which grow with the value: NaN and infinity stand above every limit, and the
    // sign bit of a NaN makes the number greater still.
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

/// Three rows of coordinates as one row of texels.
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

}  // namespace relief
