// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far a picture is from the one that it should be: as an eye sees it (FLIP), and in decibels.
/// Tests: tests/accuracy/picture_error_test.cpp.
#pragma once

#include "relief/accuracy/experiment.h"
#include "relief/mesh/image.h"

namespace relief {

struct PictureError {
    ErrorFigures
        figures;  ///< FLIP by pixel, 0 to 1; psnr is of sRGB codes, infinite where none differs.
    Image map;    ///< FLIP of each pixel: one float channel.
};

/// \param truth    three float channels, linear light
/// \param picture  8-bit sRGB of three channels, as on a screen
/// \return of the truth as a screen would show it, rounded to codes, too
/// \throws InvalidInput if sizes or channels differ
PictureError picture_error(const Image& truth, const Image& picture);

/// What many samples show: the mean of squares of pixels, in linear light.
///
/// \param linear  float channels; width and height multiples of `side`
/// \param side    of a square, at least 1
Image averaged(const Image& linear, int side);

/// The first three channels.
Image without_alpha(const Image& image);

}  // namespace relief
