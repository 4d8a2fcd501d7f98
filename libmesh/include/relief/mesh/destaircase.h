// SPDX-License-Identifier: Apache-2.0
/// \file
/// Removes the quantization steps of 8-bit height maps. No height changes by more than its rounding
/// error.
/// Tests: tests/mesh/image/height_map_test.cpp.
#pragma once

#include "relief/mesh/bump.h"
#include "relief/mesh/image.h"

namespace relief {

struct DestaircaseOptions {
    Wraps wrap;
    /// The step between adjacent codes, where 1.0 is white. 0: height_depth() determines it.
    double step = 0.0;
};

struct Destaircased {
    Image heights;      ///< One float channel.
    double step = 0.0;  ///< 0 if the map has no steps; its heights are unchanged then.
};

/// Estimates the heights before they were quantized.
///
/// \param height  one channel of 8, 16 or 32 bits
/// \return for every texel a height within half a step of the stored one, so that rounding
///         reproduces the map. Planes and smooth curves become smooth; edges of several steps and
///         constant maps do not change. Non-finite heights do not change either, and their
///         neighbors are smoothed as if the hole were filled, as in normals_from_height(); beyond
///         the border `wrap` applies. The same bits for any number of threads
/// \throws InvalidInput if the image is empty or has more than one channel, or the step is negative
///         or not finite
///
/// Each texel takes the value of a smoothed surface. The scale of smoothing grows, up to a standard
/// deviation of 37 texels, as long as the mean squared deviation from the surrounding codes does
/// not exceed that of rounding, which is 1/12 of the squared step (the choice of scale is that of
/// [Lepski 1991]). The value is then clamped to half a step around the code. Texels farther away
/// than 400 have no effect.
Destaircased destaircase(const Image& height, const DestaircaseOptions& options = {});

}  // namespace relief
