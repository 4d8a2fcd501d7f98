// SPDX-License-Identifier: Apache-2.0
/// \file
/// Values as a picture to look at. Tests: tests/mesh/image/heat_picture_test.cpp.
#pragma once

#include "relief/mesh/image.h"

namespace relief {

/// Values as a picture to look at: 8-bit sRGB from black over violet and orange to pale yellow,
/// always brighter with larger values.
///
/// \param values  one float channel
/// \param brightest  the value that is shown brightest, more than 0; larger ones look the same,
///                   0 and below are black, NaN is pure green
/// \throws InvalidInput if the image is empty or something else, or brightest is not positive
Image heat_picture(const Image& values, double brightest);

}  // namespace relief
