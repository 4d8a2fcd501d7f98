// SPDX-License-Identifier: Apache-2.0
/// \file
/// Reads and writes image files by rows, so that images may be larger than memory.
///
/// Samples and errors are those of whole images (image_file.h). Memory holds a band of rows of
/// about 16 MiB, or one row of tiles if that is larger, and the rows of the caller.
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

/// Largest image that is read or written by rows, in samples. A row may have at most
/// max_image_samples.
inline constexpr std::size_t max_streamed_samples = std::size_t{1} << 40;

/// Reads the rows of an image file in order from the top.
///
/// PNG, TIFF and EXR files are decoded on demand from the file, which must not change meanwhile.
/// All other formats, interlaced PNG files, and PNG files with a single transparent color are
/// decoded completely by the constructor; they are limited to max_image_samples, as for
/// read_image().
class ImageRowReader {
  public:
    /// Opens a file and reads its header.
    /// \throws FileError as read_image() does, for any problem that the header shows
    explicit ImageRowReader(const std::filesystem::path& file);
    ~ImageRowReader();
    ImageRowReader(ImageRowReader&&) noexcept;
    ImageRowReader& operator=(ImageRowReader&&) noexcept;

    /// Size, channels, bits (8, 16 or 32 for float) and text of the whole image.
    [[nodiscard]] const ImageInfo& info() const;
    /// width * channels * bits / 8.
    [[nodiscard]] std::size_t row_bytes() const;
    /// The next row; the height after the last one.
    [[nodiscard]] int next_row() const;
    /// Returns true if rows are decoded on demand; otherwise the whole image is in memory.
    [[nodiscard]] bool is_streamed() const;

    /// Reads the next rows, tightly packed, in native byte order, as from read_image().
    /// \param rows  whole rows, aligned for the samples' type: std::as_writable_bytes() of a span
    /// \throws InvalidInput if it is not a whole number of rows, or has more than are left;
    ///         FileError if rows are damaged, after which the reader cannot be used
    void read(std::span<std::byte> rows);

    /// Skips rows. TIFF and EXR do not decode them, so errors in them are not noticed. \throws as
    /// read()
    void skip(int rows);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// The properties of an image, without its samples.
struct ImageShape {
    int width = 0;
    int height = 0;
    int channels = 0;
    int bits = 0;  ///< 8, 16 or 32: the type of the samples for write().
    ColorSpace color_space = ColorSpace::data;
    /// Names of the channels, for images of up to 8 channels that are not colors: EXR and TIFF
    /// only, and only EXR stores the names. Empty for gray, RGB and alpha.
    std::vector<std::string> channel_names{};
};

/// Writes an image file in order from the top.
///
/// The file replaces an old one in finish(). Without finish(), the destructor removes the new file,
/// and the old one is not changed. The same samples give the same bytes, independent of the number
/// of rows per call and of threads.
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

    /// Writes the next rows, tightly packed, in native byte order.
    /// \param rows  whole rows, aligned for the samples' type: std::as_bytes() of a span
    /// \throws InvalidInput if it is not a whole number of rows, or has more than are left;
    ///         FileError if rows cannot be written, after which writing is no longer possible
    void write(std::span<const std::byte> rows);

    /// Writes remaining rows and closes the temporary file, which stays beside the old file until
    /// finish().
    /// \param report  gets "texel beyond half's range" for EXR files of halves
    /// \throws InvalidInput if rows are missing; FileError
    void complete(Report& report);

    /// Calls complete() if needed, and renames the file.
    /// \param report  gets "texel beyond half's range" for EXR files of halves
    /// \throws InvalidInput if rows are missing; FileError
    void finish(Report& report);
    void finish();

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace relief
