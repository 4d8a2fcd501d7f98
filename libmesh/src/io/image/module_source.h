// SPDX-License-Identifier: Apache-2.0
/// \file
/// Reading by way of the image module: whole images from memory, or rows from a file.
/// Tests: tests/mesh/io/image/image_rows_test.cpp, image_file_test.cpp.
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "io/image/image_file_container.h"
#include "io/image/row_source.h"

namespace relief {

/// Rows of a TIFF or EXR file, which is read as far as they are asked for.
/// \throws FileError as read_image() does
std::unique_ptr<RowSource> open_module_rows(const std::filesystem::path& file);

/// The same for an encoded image in memory, of any format, which must outlive them.
/// \param container  what examine_image() made of it
std::unique_ptr<RowSource> module_rows(ImageContainer container, std::span<const std::byte> bytes,
                                       const std::filesystem::path& name);

/// A whole image by the module and nothing else, which is the judge of what others find odd.
/// \throws FileError
Image read_by_module(const std::filesystem::path& file);

}  // namespace relief
