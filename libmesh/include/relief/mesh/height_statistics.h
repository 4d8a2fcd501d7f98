// SPDX-License-Identifier: Apache-2.0
/// \file
/// Analyzes a height map: whether it tiles, how many bits it uses, and how noisy it is.
/// Tests: tests/mesh/image/height_map_test.cpp.
#pragma once

#include "relief/mesh/bump.h"
#include "relief/mesh/image.h"

namespace relief {

/// The continuity of a map across the seams between its last and first column, and last and first
/// row.
struct Tiling {
    /// RMS change across the seam, divided by the maximum RMS change between adjacent columns or
    /// rows inside (of at most 256 pairs). 0 if the seam has no change; infinite if only the seam
    /// has one.
    double seam_x = 0.0;
    double seam_y = 0.0;

    /// Maximum value for a map that tiles.
    static constexpr double max_seam = 1.25;
    [[nodiscard]] bool tiles_x() const { return seam_x <= max_seam; }
    [[nodiscard]] bool tiles_y() const { return seam_y <= max_seam; }
    /// Wrap::repeat for axes along which the map tiles, else Wrap::clamp.
    [[nodiscard]] Wraps wraps() const {
        return {tiles_x() ? Wrap::repeat : Wrap::clamp, tiles_y() ? Wrap::repeat : Wrap::clamp};
    }
};

/// Measures the seams of a height map.
///
/// \param height  one channel of 8, 16 or 32 bits; texels that are not finite are ignored
/// \throws InvalidInput if the image is empty or has more than one channel
///
/// Maps of pure noise, and maps with a constant border, also count as tiling.
Tiling detect_tiling(const Image& height);

/// The quantization of a height map.
struct HeightDepth {
    /// The smallest n for which every height is a multiple of 1 / (2^n - 1), or of 1 / 2^n, up to
    /// float rounding: 1 to 16. 10 for multiples of 1 / 765, the means of three 8-bit colors. 0 if
    /// there is none (float maps).
    int bits = 0;
    /// The step between the values that occur, in the unit of heights (1.0 is white): 257 / 65535
    /// for 8 bits stored in 16. 0 if `bits` is 0.
    double step = 0.0;
};

/// Detects the quantization of a height map.
///
/// \param height  one channel of 8, 16 or 32 bits; texels that are not finite are ignored
/// \throws InvalidInput if the image is empty or has more than one channel
///
/// For a constant map, `bits` is 1 and `step` is the height, or 1 for height 0.
HeightDepth height_depth(const Image& height);

/// Estimates the standard deviation of the noise in a height map, in the unit of heights. The
/// estimate includes fine detail: it is an upper bound for smooth maps, and meaningless for maps
/// with detail of 2 or 3 texels.
///
/// \return 0 for maps of fewer than 3 texels a side
///
/// Source: [Immerkaer 1996].
double height_noise(const Image& height);

}  // namespace relief
