// SPDX-License-Identifier: Apache-2.0
/// \file
/// Compares two images: by their samples, by perceived difference (FLIP), and in degrees for images
/// of normals.
#pragma once

#include <limits>
#include <numbers>

#include "relief/export.h"
#include "relief/mesh/image.h"
#include "relief/mesh/statistics.h"

namespace RELIEF_API relief {
namespace shade {

/// Differences of corresponding samples, in units of the images' own range (8 bit: 0 to 255).
struct ImageDifference {
    double max = 0;
    double mean = 0;
    double rms = 0;
    /// Peak signal-to-noise ratio in decibels, 20 log10(peak / rms), the peak being 255, 65535 or
    /// (float) 1. Infinity for equal images, minus infinity if rms is infinite.
    double psnr = std::numeric_limits<double>::infinity();
    std::size_t differing_pixels = 0;  ///< Pixels in which any sample differs.
};

/// Compares corresponding samples. A NaN on one side only counts as an infinite difference; on both
/// sides as none.
/// \throws InvalidInput if sizes, channels or sample types differ
ImageDifference compare(const Image& a, const Image& b);

/// The pixels per degree of a screen of 3840 pixels, seen from a distance of its width.
inline constexpr double default_pixels_per_degree = 3840.0 * std::numbers::pi / 180.0;

/// The perceived difference when two pictures alternate at one position, from 0 (none) to 1
/// (maximal).
struct FlipDifference {
    double mean = 0;
    double max = 0;
    Image map;  ///< The error of each pixel: one float channel, data.
};

/// Computes LDR-FLIP [Andersson et al. 2020].
///
/// \param reference,test  colors, sRGB or linear, of any bits and channels, which may differ;
///         compared as a screen shows them, clamped to [0,1]. Transparent pixels are compared over
///         black and over white, and the larger error counts
/// \param pixels_per_degree  10 to 1000; more make details smaller and their errors weaker
/// \return NaNs count as 0, and the error of their pixel is 1 unless the other picture's pixel has
///         NaNs in the same channels. The result is the same bits if the pictures are exchanged
/// \throws InvalidInput if one is empty or holds data instead of colors, sizes differ, or
///         pixels_per_degree is out of range
FlipDifference flip_difference(const Image& reference, const Image& test,
                               double pixels_per_degree = default_pixels_per_degree);

/// Angles between corresponding directions, in degrees.
struct AngleDifference {
    /// Covers all texels. `undefined` counts those without a direction (zero or not finite) in one
    /// image or in both, which count as angles as well.
    ErrorStats angles;
    Image map;  ///< Degrees for each texel: one float channel, data.
};

/// Computes the angles between corresponding directions.
///
/// \param a,b  three float channels of directions of any length, as from decode_normal_map()
/// \return angles by atan2, which is accurate near 0 and 180. A texel without direction on one side
///         only counts as 180 degrees; on both sides as 0
/// \throws InvalidInput if one is empty or is not three float channels, or sizes differ
AngleDifference angle_difference(const Image& a, const Image& b);

}  // namespace shade
}  // namespace relief
