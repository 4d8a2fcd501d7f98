// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far two pictures are apart, in numbers. Tests: tests/shade/render/image_compare_test.cpp.
#pragma once

#include "relief/mesh/image.h"

namespace relief {

/// Differences of corresponding samples, in units of the images' own range (8 bit: 0 to 255).
struct ImageDifference {
    double max = 0;
    double mean = 0;
    double rms = 0;
    std::size_t differing_pixels = 0;  ///< Pixels in which any sample differs.
};

/// \throws InvalidInput if sizes, channels or sample types differ. A NaN on one side only counts as
///         an infinite difference; on both sides as none.
ImageDifference compare(const Image& a, const Image& b);

}  // namespace relief
