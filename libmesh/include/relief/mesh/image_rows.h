// SPDX-License-Identifier: Apache-2.0
/// \file
/// Image files read and written row by row, so that images larger than memory can be worked on.
///
/// Samples mean, and errors say, what they do for whole images (image_file.h). What is held at
/// once: a band of rows of some 16 MiB or of one row of tiles, whichever is more, and the rows of
/// the caller. Tests: tests/mesh/io/image/image_rows_test.cpp, image_rows_memory_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"

namespace relief {

/// Largest image that is read or written by rows, in samples; no row may have more than
/// max_image_samples.
inline constexpr std::size_t max_streamed_samples = std::size_t{1} << 40;

/// Rows of an image file in order from the top.
///
/// PNG, TIFF and EXR files are decoded as far as rows are asked for, from the file itself, which
/// must stay as it is meanwhile. All other formats are decoded whole when they are opened, and so
/// are interlaced PNG files and those with a single transparent colour; they are held to
/// max_image_samples, like read_image().
class ImageRowReader {
  public:
    /// Opens a file and reads its header.
    /// \throws FileError as read_image() does, as far as headers tell
    explicit ImageRowReader(const std::filesystem::path& file);
    ~ImageRowReader();
    ImageRowReader(ImageRowReader&&) noexcept;
    ImageRowReader& operator=(ImageRowReader&&) noexcept;

    /// Size, channels, bits (8, 16 or 32 for float) and text of the whole image.
    [[nodiscard]] const ImageInfo& info() const;
    /// width * channels * bits / 8.
    [[nodiscard]] std::size_t row_bytes() const;
    /// The row that is read next; the height where all have been.
    [[nodiscard]] int next_row() const;
    /// Whether rows are decoded as they are asked for; else the whole image is in memory.
    [[nodiscard]] bool is_streamed() const;

    /// The next rows, tightly packed, in the machine's byte order, as read_image() gives them.
    /// \param rows  whole rows, aligned for the samples' type: std::as_writable_bytes() of a span
    /// \throws InvalidInput if it holds no whole number of rows, or more than are left; FileError
    ///         if they are damaged: the reader is of no use from then on
    void read(std::span<std::byte> rows);

    /// Leaves rows out. Where a format allows it (TIFF, EXR) they are not decoded, and what is
    /// wrong with them stays unnoticed. \throws as read()
    void skip(int rows);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// What an image will be, before its samples are known.
struct ImageShape {
    int width = 0;
    int height = 0;
    int channels = 0;
    int bits = 0;  ///< 8, 16 or 32, of the samples that write() is given.
    ColorSpace color_space = ColorSpace::data;
    /// What the channels are called, for images that are no colours, of up to 8 channels: EXR and
    /// TIFF only, and only EXR keeps the names. Empty: grey, RGB and alpha.
    std::vector<std::string> channel_names{};
};

/// An image file being written in order from the top.
///
/// The file takes the old one's place in finish(), and not before; a writer that is destroyed
/// without finish() leaves no file behind and the old one unharmed. The same samples give the same
/// bytes, however they were cut into calls and whatever the number of threads.
class ImageRowWriter {
  public:
    /// \throws FileError, InvalidInput as write_image() does
    ImageRowWriter(const std::filesystem::path& file, const ImageShape& shape,
                   const std::map<std::string, std::string>& metadata = {},
                   const ImageWriteOptions& options = {});
    ~ImageRowWriter();
    ImageRowWriter(ImageRowWriter&&) noexcept;
    ImageRowWriter& operator=(ImageRowWriter&&) noexcept;

    /// width * channels * bits / 8.
    [[nodiscard]] std::size_t row_bytes() const;

    /// The next rows, tightly packed, in the machine's byte order.
    /// \param rows  whole rows, aligned for the samples' type: std::as_bytes() of a span
    /// \throws InvalidInput if it holds no whole number of rows, or more than the image has left;
    ///         FileError if they cannot be written: nothing more can be written then
    void write(std::span<const std::byte> rows);

    /// Writes what is left and closes the file, which stays beside the old one until finish().
    /// \param report  gets "texel beyond half's range" for EXR files of halves
    /// \throws InvalidInput if rows are missing; FileError
    void complete(Report& report);

    /// Completes the file, unless that is done, and renames it into place.
    /// \param report  gets "texel beyond half's range" for EXR files of halves
    /// \throws InvalidInput if rows are missing; FileError
    void finish(Report& report);
    void finish();

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace relief
