// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far two pictures are apart: in numbers, as the eye sees it (FLIP), and in degrees for
/// pictures of normals. Tests: tests/shade/compare/image_compare_test.cpp, flip_test.cpp,
/// angle_difference_test.cpp.
#pragma once

#include <limits>
#include <numbers>

#include "relief/mesh/image.h"

namespace relief {

/// Differences of corresponding samples, in units of the images' own range (8 bit: 0 to 255).
struct ImageDifference {
    double max = 0;
    double mean = 0;
    double rms = 0;
    /// Peak signal-to-noise ratio in decibels, 20 log10(peak / rms), the peak being 255, 65535 or
    /// (float) 1. Infinity where nothing differs, minus infinity where rms is infinite.
    double psnr = std::numeric_limits<double>::infinity();
    std::size_t differing_pixels = 0;  ///< Pixels in which any sample differs.
};

/// \throws InvalidInput if sizes, channels or sample types differ. A NaN on one side only counts as
///         an infinite difference; on both sides as none.
ImageDifference compare(const Image& a, const Image& b);

/// How many pixels an eye sees in a degree: a screen of 3840 pixels, from as far as it is wide.
inline constexpr double default_pixels_per_degree = 3840.0 * std::numbers::pi / 180.0;

/// The difference that an eye sees when two pictures alternate in one place: 0 none, 1 the most
/// there is.
struct FlipDifference {
    double mean = 0;
    double max = 0;
    Image map;  ///< The error of each pixel: one float channel, data.
};

/// LDR-FLIP [Andersson et al. 2020].
///
/// \param reference,test  colours, sRGB or linear, of any bits and channels, also of different
///                        ones; compared as a screen shows them, cut to [0,1]. Where a pixel lets
///                        the background through, it is compared over black and over white, and
///                        the larger error counts.
/// \param pixels_per_degree  10 to 1000; more make details smaller and their errors weaker
/// \return a NaN counts as 0, and its pixel's error is 1 unless the other picture's pixel has NaN
///         in the same channels. The same both ways round, bit for bit.
/// \throws InvalidInput if one is empty or holds data instead of colours, sizes differ, or
///         pixels_per_degree is out of range
FlipDifference flip_difference(const Image& reference, const Image& test,
                               double pixels_per_degree = default_pixels_per_degree);

/// Angles between corresponding directions, in degrees.
struct AngleDifference {
    double mean = 0;
    double p99 = 0;  ///< 99 of 100 texels are no farther apart.
    double max = 0;
    /// Texels with no direction (no length, or not finite) in one image or in both.
    std::size_t undefined = 0;
    Image map;  ///< Degrees for each texel: one float channel, data.
};

/// \param a,b  three float channels of directions of any length, as decode_normal_map() gives them
///             for a normal map
/// \return angles by atan2, which is exact near 0 and 180. A texel without direction on one side
///         only counts as 180 degrees; on both sides as 0.
/// \throws InvalidInput if one is empty or is not three float channels, or sizes differ
AngleDifference angle_difference(const Image& a, const Image& b);

}  // namespace relief
