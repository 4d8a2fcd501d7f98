// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a height map itself says about how it should be converted: whether it tiles, how many bits
/// were really used, how noisy it is. Tests: tests/mesh/image/heights/height_statistics_test.cpp.
#pragma once

#include "relief/mesh/bump.h"
#include "relief/mesh/image.h"

namespace relief {

/// Whether a map goes on smoothly across the seam between its last and first column, and row.
struct Tiling {
    /// Root mean square change across the seam, over the greatest between neighbours inside (of 256
    /// pairs at most). 0 where the seam shows no change; infinite where only the seam does.
    double seam_x = 0.0;
    double seam_y = 0.0;

    /// A seam that changes hardly more than the inside does is none.
    static constexpr double largest_seam = 1.25;
    [[nodiscard]] bool tiles_x() const { return seam_x <= largest_seam; }
    [[nodiscard]] bool tiles_y() const { return seam_y <= largest_seam; }
    /// Repeat where the map tiles, else clamp.
    [[nodiscard]] Wraps wraps() const {
        return {tiles_x() ? Wrap::repeat : Wrap::clamp, tiles_y() ? Wrap::repeat : Wrap::clamp};
    }
};

/// \param height  one channel of 8, 16 or 32 bits; texels that are not finite are left out
/// \throws InvalidInput if the image is empty or has more than one channel
///
/// A map that is mere noise is taken to tile, which does it no harm; so is one with an even border.
Tiling detect_tiling(const Image& height);

/// How fine the heights are.
struct HeightDepth {
    /// The least n for which every height is a multiple of 1 / (2^n - 1), or of 1 / 2^n, to within
    /// float's rounding: 1 to 16; 10 for multiples of 1 / 765, the means of three 8-bit colours; 0
    /// where there is none (float maps).
    int bits = 0;
    /// The step between the values that occur, in the unit of heights (1.0 is white): 257 / 65535
    /// for 8 bits stored as 16. 0 where `bits` is.
    double step = 0.0;
};

/// \param height  one channel of 8, 16 or 32 bits; texels that are not finite are left out
/// \throws InvalidInput if the image is empty or has more than one channel
///
/// A constant map has no steps: bits is 1, step the height itself or 1.
HeightDepth height_depth(const Image& height);

/// Standard deviation of the noise in the heights, in their unit, as far as it can be told from
/// detail: an upper bound for smooth maps, of no meaning for maps with detail of 2 or 3 texels.
///
/// \return 0 for maps of fewer than 3 texels a side
/// Source: [Immerkaer 1996].
double height_noise(const Image& height);

}  // namespace relief
