// SPDX-License-Identifier: Apache-2.0
/// \file
/// Errors of normal maps (angles per texel) and of images (FLIP and PSNR) against a ground truth.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/accuracy/experiment.h"
#include "relief/mesh/image.h"
#include "relief/mesh/statistics.h"

namespace relief {

/// Computes the angle between each texel and the ground truth, in degrees.
///
/// \param normals  three float channels, y up
/// \param ground_truth    one unit normal per texel, row by row from the top
/// \return one float channel; NaN if either direction is undefined
/// \throws InvalidInput if the counts differ
Image angles_of(const Image& normals, std::span<const glm::dvec3> ground_truth);

/// The angles of angles_of() as a list, without those within `margin` texels of the border.
std::vector<float> inner_angles(const Image& normals, std::span<const glm::dvec3> ground_truth,
                                int margin);

/// Statistics of inner_angles().
ErrorStats map_errors(const Image& normals, std::span<const glm::dvec3> ground_truth,
                      int margin = 0);

struct PictureError {
    ErrorStats
        figures;  ///< FLIP per pixel, 0 to 1; psnr is of sRGB codes, infinite if all are equal.
    Image map;    ///< FLIP per pixel: one float channel.
};

/// Compares an image with a reference that is rounded to 8-bit sRGB as well.
///
/// \param ground_truth    three float channels, linear light
/// \param picture  8-bit sRGB, three channels
/// \throws InvalidInput if sizes or channels differ
PictureError picture_error(const Image& ground_truth, const Image& picture);

/// Averages squares of `side` x `side` pixels in linear light.
///
/// \param linear  float channels; width and height are multiples of `side`
/// \param side    at least 1
Image averaged(const Image& linear, int side);

/// The first three channels.
Image without_alpha(const Image& image);

}  // namespace relief
