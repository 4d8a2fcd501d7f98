// SPDX-License-Identifier: Apache-2.0
/// \file
/// From a bump map (a field of heights) to unit normals, by finite differences.
/// Tests: tests/mesh/image/bump_test.cpp.
#pragma once

#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace relief {

/// How the slope is estimated from neighbouring heights. All kernels have unit gain on a plane, so
/// that choosing another one never changes the depth.
enum class Kernel {
    central3,  ///< Half the difference of the two neighbours. Second order, least blur.
    sobel3,    ///< Central differences of three rows, weighted 1 2 1. Second order, less noise.
};

/// What lies beyond the border of the image.
enum class Wrap {
    repeat,  ///< The opposite edge: the map tiles.
    clamp,   ///< Nothing. The border slope is a one-sided difference, over one step.
};

struct BumpOptions {
    Kernel kernel = Kernel::sobel3;
    Wrap wrap = Wrap::repeat;
    /// Height in texels that the value 1.0 stands for, within +-1e30; negative turns bumps into
    /// dents.
    double strength = 16.0;
};

/// The heights in an image: one float channel.
///
/// Grey as it is; RGB by its mean (data has no luminance); alpha is left out. Integer samples are
/// divided by their maximum, and no colour space is decoded.
/// \throws InvalidInput if the image is empty
Image height_field(const Image& image);

/// Unit normals of a height field, in tangent space: x to the right, y up in the image, z out.
///
/// \param height  one float channel, as from height_field; texels are square
/// \param report  counts texels whose height is not finite: each is read as the mean of the finite
///                heights in the smallest square around it that holds any (beyond the border by
///                `wrap`), or 0 where the image has none
/// \return three float channels: normalize(-dh/dx, -dh/dy, 1), with y upwards; a constant field
///         gives exactly (0,0,1). Computed in double and rounded once; the same bits for any number
///         of threads.
/// \throws InvalidInput if the image is empty, has more than one channel or is not float, or if the
///         strength is out of range
///
/// Source: [Blinn 1978]; kernels as in [Sobel and Feldman 1968], scaled to unit gain.
Image normals_from_height(const Image& height, const BumpOptions& options, Report& report);

}  // namespace relief
