// SPDX-License-Identifier: Apache-2.0
/// \file
/// Interfaces of the decoders behind ImageRowReader and the encoders behind ImageRowWriter.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "relief/mesh/image_file.h"

namespace relief::detail {

/// A decoder that returns rows in order, tightly packed.
class RowSource {
  public:
    virtual ~RowSource() = default;
    [[nodiscard]] virtual const ImageInfo& info() const = 0;
    /// Returns true if rows are decoded on demand.
    [[nodiscard]] virtual bool is_streamed() const = 0;
    /// Reads the next rows; there must be enough. \throws FileError
    virtual void read(std::byte* rows, std::size_t count) = 0;
    virtual void skip(std::size_t count) = 0;
};

/// Bytes of a row of samples.
std::size_t row_bytes_of(const ImageInfo& info);

/// Checks the size of an image that is decoded as a whole. \throws FileError if it has more than
/// max_image_samples or exceeds a limit of the process (relief/mesh/limits.h)
void require_image_fits(const ImageInfo& info, const std::filesystem::path& name);

/// \throws FileError if an image is too large to be read by rows
void check_streamed_size(const ImageInfo& info, const std::filesystem::path& name);

/// Reads all rows of a new source; the caller sets the color space. Memory grows with the rows, so
/// that a false header costs nothing. \throws FileError
Image read_all(RowSource& rows, const std::filesystem::path& name);

/// Rows of an image in memory.
std::unique_ptr<RowSource> rows_of_image(Image image, ImageInfo info);

/// Opens a file whose format can be read by rows; null if it must be read as a whole.
/// \throws FileError as read_image() does
std::unique_ptr<RowSource> open_streamed_rows(const std::filesystem::path& file);

/// The parameters of a file, checked: the format can hold them.
struct RowSinkPlan {
    std::filesystem::path file;     ///< For messages.
    std::filesystem::path written;  ///< The file that is written.
    const char* format = nullptr;   ///< OpenImageIO's name.
    ImageShape shape;
    std::map<std::string, std::string> metadata;
    ImageWriteOptions options;

    [[nodiscard]] std::size_t row_bytes() const;
};

/// An encoder that takes rows in order. Its output does not depend on how they are grouped.
class RowSink {
  public:
    virtual ~RowSink() = default;
    /// \throws FileError
    virtual void write(const std::byte* rows, int count) = 0;
    /// Completes the file after all rows. \throws FileError
    virtual void finish() = 0;
    /// Reports samples that were changed.
    virtual void report(Report&) const {}
};

/// Returns a whole PNG file in memory.
std::string encode_png(const Image& image, const std::map<std::string, std::string>& text);

std::unique_ptr<RowSink> make_png_sink(const RowSinkPlan& plan);
std::unique_ptr<RowSink> make_module_sink(const RowSinkPlan& plan);
std::unique_ptr<RowSink> make_texture_sink(const RowSinkPlan& plan);

/// Checks that a texture can hold a map of the kind that its text entries state.
/// \throws InvalidInput
void check_texture_shape(const ImageShape& shape,
                         const std::map<std::string, std::string>& metadata);

}  // namespace relief::detail
