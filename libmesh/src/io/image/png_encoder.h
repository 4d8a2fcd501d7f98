// SPDX-License-Identifier: Apache-2.0
/// \file
/// Writing PNG files without the image module. Tests: tests/mesh/io/image/png_test.cpp.
#pragma once

#include <map>
#include <string>

#include "relief/mesh/image.h"

namespace relief {

/// A whole PNG file: header, sRGB chunk where the image is sRGB-coded, a tEXt chunk for each entry,
/// all samples. The same image gives the same bytes.
/// \param image  of 1 to 4 channels, 8 or 16 bits
std::string encode_png(const Image& image, const std::map<std::string, std::string>& text);

}  // namespace relief
