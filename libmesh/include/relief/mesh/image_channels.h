// SPDX-License-Identifier: Apache-2.0
/// \file
/// Single channels of images, and alpha put beside colours and taken away again.
/// Tests: tests/mesh/image/image_channels_test.cpp.
#pragma once

#include "relief/mesh/image.h"

namespace relief {

/// One channel by itself, as float: integer samples divided by their maximum.
/// \throws InvalidInput if there is no such channel
Image channel_of(const Image& image, int channel);

/// An image of three channels with a fourth.
///
/// \param alpha  one float channel of the same size; in 8 and 16 bits the nearest of its codes,
/// what
///               lies outside [0,1] (or is NaN) being the nearest of these (or 0)
/// \throws InvalidInput if the images are not of these kinds, or not of one size
Image with_alpha(const Image& image, const Image& alpha);

/// Takes the fourth channel away. \throws InvalidInput if the image has not four
void drop_alpha(Image& image);

}  // namespace relief
