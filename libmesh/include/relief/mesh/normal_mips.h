// SPDX-License-Identifier: Apache-2.0
/// \file
/// Computes mip levels of normal maps, and converts the shortening of averaged normals to slope
/// variance and roughness.
/// Tests: tests/mesh/image/normal_resize_test.cpp.
#pragma once

#include <vector>

#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace relief {

/// Computes the levels of a normal map down to one texel, with the sizes and weights of
/// mip_levels().
///
/// \param normals  three float channels, unit
/// \return mean vectors with a length of at most 1: each texel is the mean of the area that it
///         covers in the map itself, without normalization in between
/// \throws InvalidInput if the image is empty or not three float channels
std::vector<Image> normal_mip_levels(const Image& normals);

/// Normalizes mean vectors, in place.
///
/// \param report  counts vectors of length 0 (below 1e-6, because of rounding), such as those of a
///         peak whose sides cancel: they become flat
/// \return their previous lengths, from 0 to 1: one float channel
Image split_lengths(Image& means, Report& report);

/// Returns the slope variance per axis (the mean of both axes) of unit normals whose mean has this
/// length: (1 / length^2 - 1) / 2. It is exact if all normals have the same angle to the mean, and
/// otherwise too small: 95% of the variance of normally distributed slopes with standard deviation
/// 0.2, 82% with 0.5.
///
/// \param length  clamped to [1e-3, 1]
double slope_variance_of_length(double length);

/// Returns the factor for a Phong or Blinn-Phong exponent for normals whose mean has this length:
/// length / (length + exponent (1 - length)). Source: [Toksvig 2005].
double toksvig_factor(double length, double exponent);

/// Adds a slope variance to a roughness (of glTF: alpha = roughness^2): alpha'^2 = alpha^2 + 2
/// variance, at most 1.
///
/// The slopes of Beckmann's distribution have the variance alpha^2 / 2 along each axis, and
/// variances add [Olano and Baker 2010]. Those of GGX have no finite variance; it uses the same
/// alpha by convention.
double roughness_with_variance(double roughness, double variance);

/// Computes the roughness of each texel of a level: one float channel.
///
/// \param lengths  as from split_lengths()
/// \param roughness  of the map itself, 0 to 1
/// \throws InvalidInput if the image is not one float channel, or the roughness is out of range
Image roughness_from_lengths(const Image& lengths, double roughness);

}  // namespace relief
