// SPDX-License-Identifier: Apache-2.0
/// \file
/// Dithering: rounds values up or down by a fixed pattern, so that the mean over a few texels is
/// more accurate than single codes. The threshold of a texel depends only on its coordinates, so
/// results do not depend on the order of computation or the number of threads.
/// Tests: tests/mesh/image/normal_map_test.cpp.
#pragma once

namespace relief {

/// The rounding of values between two codes.
enum class Dither {
    none,  ///< To the nearest code: the error is at most half a code, but constant over flat areas.
    ordered,     ///< By a Bayer matrix of 16 x 16: the shortest period, but a visible pattern.
    blue_noise,  ///< By a tile of 64 x 64 without low frequencies: least visible.
};

/// Returns the threshold of a texel: a value between two codes is rounded up if its fraction
/// exceeds the threshold.
///
/// \param dither  not `none`
/// \param x, y  coordinates in the whole image, not negative
/// \param channel  0 to 2; each channel uses the same tile with another offset. With blue noise,
///         the errors of the channels are almost uncorrelated
/// \return (k + 0.5) / n, where n is 256 or 4096 and each k from 0 to n - 1 occurs once in a tile.
///         It is never 0, so a value that equals a code gets that code: flat texels stay flat,
///         without noise
///
/// The tiles are computed on first use in integer arithmetic, with the same result on every
/// machine. Source: [Bayer 1973], [Ulichney 1993].
float dither_threshold(Dither dither, int x, int y, int channel);

}  // namespace relief
