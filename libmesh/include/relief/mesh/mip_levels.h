// SPDX-License-Identifier: Apache-2.0
/// \file
/// Computes the mip levels of an image.
/// Tests: tests/mesh/image/image_test.cpp.
#pragma once

#include <vector>

#include "relief/mesh/image.h"

namespace relief {

/// Computes the mip levels below the image itself, down to one texel. Each level has half the width
/// and height of the previous one, rounded down, but at least 1.
///
/// \param image  8, 16 or 32 bits, 1 to 4 channels
/// \return images of the same format. A texel is the mean of the area that it covers in the
///         previous level, with weights by covered area for odd sizes. sRGB colors are averaged in
///         linear light; alpha is averaged separately and does not weight colors. Integer samples
///         keep 16 bits between levels and are rounded to their own bits only in the result. An
///         image of one texel has no levels below it
/// \throws InvalidInput if the image is empty
///
/// The result is the same bits for any number of threads. Drivers of GPUs use different filters.
std::vector<Image> mip_levels(const Image& image);

}  // namespace relief
