// SPDX-License-Identifier: Apache-2.0
/// \file
/// Extracts single channels of images, and adds or removes alpha.
/// Tests: tests/mesh/image/image_test.cpp.
#pragma once

#include "relief/mesh/image.h"

namespace relief {

/// Extracts one channel as float; integer samples are divided by their maximum.
/// \throws InvalidInput if there is no such channel
Image channel_of(const Image& image, int channel);

/// Adds a fourth channel to an image of three channels.
///
/// \param alpha  one float channel of the same size. For images of 8 and 16 bits it is clamped to
///         [0,1] (NaN becomes 0) and rounded to the nearest code
/// \throws InvalidInput if the images have other formats or differ in size
Image with_alpha(const Image& image, const Image& alpha);

/// Removes the fourth channel. \throws InvalidInput if the image does not have four channels
void drop_alpha(Image& image);

}  // namespace relief
