// SPDX-License-Identifier: Apache-2.0
/// \file
/// Dithering: rounding up or down by a pattern, so that the mean over a few texels is what no
/// single code can say. Deterministic: a texel's place alone decides its threshold, whatever part
/// of an image is made when, by how many threads. Tests: tests/mesh/image/normals/dither_test.cpp.
#pragma once

namespace relief {

/// How numbers between two codes are rounded.
enum class Dither {
    none,        ///< To the nearest: at most half a code off, the same way all over a flat patch.
    ordered,     ///< By a Bayer matrix, 16 x 16: the shortest pattern, but a visible weave.
    blue_noise,  ///< By a tile of 64 x 64 without low frequencies, which the eye sees least.
};

/// What the fraction of a number between two codes must exceed for the upper one to be taken.
///
/// \param dither   not `none`
/// \param x, y     of the texel, in the whole image; not negative
/// \param channel  0 to 2: each has the same tile, moved; with blue noise their errors have
///                 next to no correlation
/// \return (k + 0.5) / n with k from 0 to n - 1, n being 256 or 4096: each once a tile. Never 0, so
///         that what a code says exactly gets that code: a flat texel stays flat, without noise.
///
/// The tiles are made on first use, of whole numbers: the same on every machine.
/// Source: [Bayer 1973], [Ulichney 1993].
float dither_threshold(Dither dither, int x, int y, int channel);

}  // namespace relief
