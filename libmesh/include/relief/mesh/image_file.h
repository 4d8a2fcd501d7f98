// SPDX-License-Identifier: Apache-2.0
/// \file
/// Reads and writes image files, whole or by rows: PNG, JPEG, TIFF, EXR, HDR and other formats of
/// OpenImageIO.
///
/// Common PNG, JPEG and texture files (texture_file.h) are decoded directly. OpenImageIO is in a
/// module that is loaded by the first image that needs it, which takes 0.2 s and 120 MB. Files are
/// decoded with it in another process, relief-image-decoder, with limits of memory and time: a file
/// that crashes or exceeds it gives a FileError. Both are searched in $RELIEF_MODULE_DIR, then in
/// the tree of the library or the program, wherever it is moved.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// Returns the tag by which a program would interpret the samples of a PNG file as colors: "sRGB",
/// "gamma 0.45455", "ICC profile" or "coding-independent code points"; the first one in the file.
/// Empty for a gamma of 1, for files without tags, and for other formats. relief does not use the
/// tags: ImageUse decides.
/// \throws FileError if the file cannot be read
std::string color_tag(const std::filesystem::path& file);

/// The purpose of an image; the tags of files are not reliable.
enum class ImageUse {
    color,  ///< Integer samples are sRGB-coded, float samples linear.
    data,   ///< Samples are numbers and never color-converted, whatever the file's tags say.
};

/// The properties of an image that are known without decoding it.
struct ImageInfo {
    int width = 0;
    int height = 0;
    int channels = 0;
    int bits = 0;  ///< 8, 16 or 32, as from read_image().
    /// Text entries; those of relief begin with "relief:".
    std::map<std::string, std::string> metadata;
};

/// Largest image that is read, in samples. Larger ones are refused before memory is allocated.
inline constexpr std::size_t max_image_samples = std::size_t{1} << 31;

/// Reads a whole image: PNG, JPEG, TIFF, EXR, HDR, BMP, TGA, PNM, DDS, KTX2, PSD or WebP. The
/// content decides the format, not the name (except for TGA, which has no signature).
///
/// \return 8, 16 or 32 bits as stored. 1, 2 and 4 bits widen to 8, 10 and 12 to 16, palettes to
/// RGB, transparent colors of PNG to alpha; half becomes float; signed and 32-bit integers become
/// float, divided by their maximum. Samples are exactly as stored, alpha is neither multiplied nor
/// divided; CMYK and YCbCr become RGB. First subimage, first mip level; for EXR the data window,
/// independent of the display window. gAMA, iCCP, Exif and the like have no effect.
/// \throws FileError if the file is missing, damaged, truncated, empty or a volume, has more than 4
///         channels or max_image_samples, announces more samples than its bytes can hold, or ends
///         its decoder by a crash or a limit
Image read_image(const std::filesystem::path& file, ImageUse use);

/// The same from memory, for images that are embedded in glTF files. `name` is for messages.
Image read_image(std::span<const std::byte> bytes, const std::string& name, ImageUse use);

/// Reads the header of a file. \throws FileError as read_image(), for any problem that the header
/// shows
ImageInfo read_image_info(const std::filesystem::path& file);

/// The same from memory. `name` is for messages.
ImageInfo read_image_info(std::span<const std::byte> bytes, const std::string& name);

/// The time that writing may take: for PNG on all threads, for TIFF by the level of deflate; no
/// effect on other formats. The samples are the same.
///
/// The figures are for normal maps as PNG; OpenImageIO's defaults write 2 to 6 MPixel/s on one
/// thread (bench/README.md). For most maps the sizes of all efforts differ by less than a tenth,
/// because the rest after prediction is noise. They differ more for stepped heights, or heights
/// that change very little.
enum class WriteEffort {
    fast,    ///< 35 to 60 MPixel/s per thread; files up to a quarter larger than OpenImageIO's.
    normal,  ///< 17 to 60 MPixel/s per thread; files at most a tenth larger, mostly smaller.
    small,   ///< 3 to 60 MPixel/s per thread; files of 0.55 to 1 of OpenImageIO's size.
};

/// Options of image files. Only `half` changes the samples.
struct ImageWriteOptions {
    WriteEffort effort = WriteEffort::normal;
    /// EXR: rounds samples to half floats (11 significant bits). Values beyond the range of half
    /// become +-65504, its largest number, and are reported as "texel beyond half's range";
    /// infinities and NaN do not change.
    bool half = false;
};

/// Writes a whole image. The extension decides the format: .png .tif .tiff .exr .hdr .jpg.
///
/// A temporary file is written and renamed: after a failure there is no partial file, and the old
/// one is unchanged. The same image gives the same bytes for any number of threads. PNG, TIFF and
/// EXR keep all samples (EXR and TIFF as float); HDR keeps 8 bits of precision and no negative
/// values; JPEG is written with quality 95.
///
/// \param metadata  text entries, which are kept if the format can hold them: PNG (tEXt), EXR, TIFF
///         (lines "key=value" of its description, read back if the key begins with "relief:"); keys
///         have 1 to 79 letters
/// \throws FileError if the file cannot be written, or for another extension
/// \throws InvalidInput if the format cannot hold these samples: float in PNG, other than 8 bits of
///         1 or 3 channels in JPEG, other than float in EXR and HDR, other than 3 channels in HDR,
///         half except in EXR; or if they would be read with another meaning: linear color in
///         integers (encode it with to_srgb() first), sRGB color in float
void write_image(const std::filesystem::path& file, const Image& image,
                 const std::map<std::string, std::string>& metadata = {},
                 const ImageWriteOptions& options = {});

/// Like write_image(), and adds changes of samples to `report`.
void write_image(const std::filesystem::path& file, const Image& image,
                 const std::map<std::string, std::string>& metadata,
                 const ImageWriteOptions& options, Report& report);

// Image files can be read and written by rows, so that images may be larger than memory.
//
// Samples and errors are those of whole images. Memory holds a band of rows of
// about 16 MiB, or one row of tiles if that is larger, and the rows of the caller.

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

// Animated PNG files (APNG) are written frame by frame. Browsers play them; other readers show the
// first frame. Source: the APNG chunks of [PNG 3], section 11.3.6.

/// Writes an animated PNG file. The file replaces an old one in finish().
class AnimatedPng {
  public:
    /// \param frames   number of frames, at least 1; the animation repeats forever
    /// \param seconds  duration of a frame, from 0 to 65
    /// \throws FileError if the file cannot be written, InvalidInput if a number is out of range
    AnimatedPng(const std::filesystem::path& file, std::uint32_t frames, double seconds);
    ~AnimatedPng();
    AnimatedPng(const AnimatedPng&) = delete;
    AnimatedPng& operator=(const AnimatedPng&) = delete;

    /// Adds a frame of 8 or 16 bits, sRGB-coded or data. Only one frame is held in memory.
    /// \throws InvalidInput if its size, channels or bits differ from the first frame's, or if
    ///         there are too many frames; FileError
    void add(const Image& frame);

    /// Completes the file. \throws InvalidInput if frames are missing; FileError
    void finish();

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace relief
