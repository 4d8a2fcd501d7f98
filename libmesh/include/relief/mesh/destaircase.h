// SPDX-License-Identifier: Apache-2.0
/// \file
/// The steps of 8-bit height maps smoothed away, without moving any height farther than rounding
/// had. Tests: tests/mesh/image/heights/destaircase_test.cpp.
#pragma once

#include "relief/mesh/bump.h"
#include "relief/mesh/image.h"

namespace relief {

struct DestaircaseOptions {
    Wraps wrap;
    /// Between neighbouring codes, 1.0 being white; unless given, as height_depth() finds it.
    double step = 0.0;
};

struct Destaircased {
    Image heights;      ///< One float channel.
    double step = 0.0;  ///< 0: the map has no steps, and its heights are as they were.
};

/// Heights as they may have been before they were rounded to whole codes.
///
/// \param height  one channel of 8, 16 or 32 bits
/// \return for every texel a height within half a step of the stored one, so that rounding gives
///         the same map again. Planes and smooth curves become so; edges of several steps stay as
///         they are. A constant map stays as it is. Heights that are not finite do as well, and
///         their neighbours are smoothed as if the hole were filled (as normals_from_height()
///         does); beyond the border by `wrap`. The same bits for any number of threads.
/// \throws InvalidInput if the image is empty or has more than one channel, or the step is negative
///         or not finite
///
/// Each texel follows smoothed surfaces from fine to wide, up to deviations of 37 texels, as long
/// as these are no farther from the codes around it than rounding is: in the mean square, 1/12 of a
/// step squared (the choice of scale is that of [Lepski 1991]). What comes of it is brought back to
/// the half step around the code. Nothing farther than 400 texels away counts.
Destaircased destaircase(const Image& height, const DestaircaseOptions& options = {});

}  // namespace relief
