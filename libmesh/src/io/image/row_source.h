// SPDX-License-Identifier: Apache-2.0
/// \file
/// Where the rows of an image being read come from: the decoders behind ImageRowReader.
/// Tests: tests/mesh/io/image/image_rows_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "relief/mesh/image_file.h"

namespace relief {

/// A decoder that hands out rows in order, tightly packed.
class RowSource {
  public:
    virtual ~RowSource() = default;
    [[nodiscard]] virtual const ImageInfo& info() const = 0;
    /// Whether rows are decoded as they are asked for.
    [[nodiscard]] virtual bool is_streamed() const = 0;
    /// The next rows, not more than there are. \throws FileError
    virtual void read(std::byte* rows, std::size_t count) = 0;
    virtual void skip(std::size_t count) = 0;
};

/// Bytes of a row of samples.
std::size_t row_bytes_of(const ImageInfo& info);

/// \throws FileError if an image is too large even for its rows
void check_streamed_size(const ImageInfo& info, const std::filesystem::path& name);

/// All rows, of which none has been read; its colour space is left to the caller. Memory is taken
/// as they come, so that a header that lies costs nothing. \throws FileError
Image read_all(RowSource& rows, const std::filesystem::path& name);

/// Rows of an image in memory.
std::unique_ptr<RowSource> rows_of_image(Image image, ImageInfo info);

}  // namespace relief
