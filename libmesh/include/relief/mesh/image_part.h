// SPDX-License-Identifier: Apache-2.0
/// \file
/// Rectangles of an image. Tests: tests/mesh/image/image_part_test.cpp.
#pragma once

#include "relief/mesh/image.h"

namespace relief {

/// A rectangle of texels; x to the right, y down.
struct ImagePart {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;

    friend bool operator==(const ImagePart&, const ImagePart&) = default;
};

/// The texels of a rectangle, as an image of the same kind.
/// \throws InvalidInput if it is empty or does not lie within
Image part_of(const Image& image, const ImagePart& part);

}  // namespace relief
