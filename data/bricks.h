// SPDX-License-Identifier: Apache-2.0
/// \file
/// A wall of weathered bricks in running bond, as heights and as color; both tile.
/// Tests: tests/mesh/image/sample_data_test.cpp.
#pragma once

#include "relief/mesh/image.h"

namespace relief::sample {

/// Heights in 16 bits, data. White is the front of the foremost brick.
Image brick_heights(int size);

/// Diffuse color in 8 bits, sRGB, of the same wall.
Image brick_colors(int size);

}  // namespace relief::sample
