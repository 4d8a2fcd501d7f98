// SPDX-License-Identifier: Apache-2.0
/// \file
/// The usual PNG and JPEG files without the image module: see png_decoder.h and jpeg_decoder.h.
/// Tests: tests/mesh/io/png/png_test.cpp, image/jpeg_test.cpp.
#pragma once

#include <optional>

#include "io/image/image_file_container.h"
#include "relief/mesh/image_file.h"

namespace relief {

/// The image; nothing where it is of no usual kind, or not intact: then the module is to judge.
/// Its colour space is left to the caller.
std::optional<Image> read_directly(const ImageContainer& container);

/// What its header and text say; nothing where it is of no usual kind.
std::optional<ImageInfo> read_info_directly(const ImageContainer& container);

}  // namespace relief
