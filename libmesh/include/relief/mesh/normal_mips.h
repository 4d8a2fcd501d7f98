// SPDX-License-Identifier: Apache-2.0
/// \file
/// Mip levels of a normal map, and what each loses: the shorter the mean of its normals, the
/// rougher the surface must be told to be. Tests: tests/mesh/image/normals/normal_mips_test.cpp.
#pragma once

#include <vector>

#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace relief {

/// The levels of a normal map down to one texel, sized and weighted as mip_levels does.
///
/// \param normals  three float channels, unit
/// \return mean vectors, at most 1 long: the mean of what a texel covers of the map itself, made
///         unit nowhere in between
/// \throws InvalidInput if the image is empty or not of three float channels
std::vector<Image> normal_mip_levels(const Image& normals);

/// Makes mean vectors unit normals, in place.
///
/// \param report  counts those of length 0 (below 1e-6: rounding), as of a peak whose sides cancel:
///                made flat
/// \return their lengths before, from 0 to 1: one float channel
Image split_lengths(Image& means, Report& report);

/// The variance of the slopes along one axis, the mean of both, that makes unit normals have a mean
/// of this length: (1 / length^2 - 1) / 2. Exact where all are equally far from the mean, less than
/// the truth else: 95 % of it for normally distributed slopes of deviation 0.2, 82 % at 0.5.
///
/// \param length  below 1e-3 taken as that; above 1 as 1
double slope_variance_of_length(double length);

/// What a Phong or Blinn-Phong exponent is to be multiplied by for normals whose mean has this
/// length: length / (length + exponent (1 - length)). Source: [Toksvig 2005].
double toksvig_factor(double length, double exponent);

/// The roughness (glTF's: alpha = roughness^2) of a surface of this roughness whose slopes have
/// this variance besides: alpha'^2 = alpha^2 + 2 variance, at most 1.
///
/// The slopes of Beckmann's distribution have the variance alpha^2 / 2 along each axis, and
/// variances add [Olano and Baker 2010]; GGX has none, and takes the same alpha by custom.
double roughness_with_variance(double roughness, double variance);

/// The roughness of each texel of a level: one float channel.
///
/// \param lengths  as from split_lengths
/// \param roughness  of the map itself, 0 to 1
/// \throws InvalidInput if the image is not of one float channel, or the roughness out of range
Image roughness_from_lengths(const Image& lengths, double roughness);

}  // namespace relief
