// SPDX-License-Identifier: Apache-2.0
/// \file
/// Renders values as a false-color image.
/// Tests: tests/mesh/image/image_test.cpp.
#pragma once

#include "relief/mesh/image.h"

namespace relief {

/// Renders values as an 8-bit sRGB image with a color map from black over violet and orange to pale
/// yellow, whose brightness increases with the value.
///
/// \param values  one float channel
/// \param brightest  the value of the brightest color, above 0. Larger values have the same color,
///         values of at most 0 are black, and NaN is pure green
/// \throws InvalidInput if the image is empty or has another format, or brightest is not positive
Image false_color_image(const Image& values, double brightest);

}  // namespace relief
