// SPDX-License-Identifier: Apache-2.0
/// \file
/// Extracts rectangles of images.
/// Tests: tests/mesh/image/image_test.cpp.
#pragma once

#include "relief/mesh/image.h"

namespace relief {

/// A rectangle of texels; x points right, y down.
struct ImagePart {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;

    friend bool operator==(const ImagePart&, const ImagePart&) = default;
};

/// Extracts a rectangle as an image of the same format.
/// \throws InvalidInput if the rectangle is empty or not inside of the image
Image part_of(const Image& image, const ImagePart& part);

}  // namespace relief
