// SPDX-License-Identifier: Apache-2.0
/// \file
/// An image at half, a quarter, an eighth of its size, as textures need it.
/// Tests: tests/mesh/image/mip_levels_test.cpp.
#pragma once

#include <vector>

#include "relief/mesh/image.h"

namespace relief {

/// The levels below the image itself, down to one texel: each half as wide and as high as the one
/// before, rounded down, but at least 1.
///
/// \param image  8, 16 or 32 bits, 1 to 4 channels
/// \return images of the same kind. A texel is the mean of what it covers of the level before,
///         where that is odd with the share it covers. sRGB colours are averaged as light; alpha
///         is averaged by itself and weighs nothing. Integers are averaged with 16 bits from one
///         level to the next, and rounded to their own only in the result. An image of one texel
///         has no levels below it.
/// \throws InvalidInput if the image is empty
///
/// The same bits for any number of threads, on any GPU: drivers do this each in their own way.
std::vector<Image> mip_levels(const Image& image);

}  // namespace relief
