// SPDX-License-Identifier: Apache-2.0
/// \file
/// Image files: PNG, JPEG, TIFF, EXR, HDR and what else OpenImageIO reads.
///
/// PNG and JPEG files of the usual kinds have a direct way. OpenImageIO stands behind a module that
/// is loaded when another image needs it and not before, because loading it alone costs 0.2 s and
/// 120 MB. The module is looked for in $RELIEF_MODULE_DIR, then in ../lib/relief beside the
/// program. Tests: tests/mesh/io/image/image_file_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace relief {

/// What an image is read for; files do not say it reliably themselves.
enum class ImageUse {
    color,  ///< Integer samples are sRGB-coded, float samples linear.
    data,   ///< Samples are numbers: never colour-converted, whatever the file's tags say.
};

/// What is known of an image without decoding it.
struct ImageInfo {
    int width = 0;
    int height = 0;
    int channels = 0;
    int bits = 0;  ///< 8, 16 or 32, as read_image would give them.
    std::map<std::string, std::string>
        metadata;  ///< Text entries; relief's own begin with "relief:".
};

/// Largest image that is read, in samples; larger headers are refused before memory is taken.
inline constexpr std::size_t max_image_samples = std::size_t{1} << 31;

/// Reads a whole image: PNG, JPEG, TIFF, EXR, HDR, BMP, TGA, PNM, DDS, PSD or WebP. The format is
/// decided by content, not by name (but for TGA, which has no signature).
///
/// \return 8, 16 or 32 bits as stored (1, 2 and 4 bits widen to 8, 10 and 12 to 16, palettes to
///         RGB, transparent colours of PNG to alpha; half becomes float; signed and 32-bit integers
///         become float, divided by their maximum); samples exactly as stored, alpha never
///         multiplied in or out; CMYK and YCbCr become RGB. First subimage, first mip level; of EXR
///         the data window, wherever it lies in the display window. gAMA, iCCP, Exif and their like
///         change nothing.
/// \throws FileError if it is missing, damaged, truncated, empty, of more than 4 channels, over
///         max_image_samples, a volume, or announces more samples than its bytes can hold
Image read_image(const std::filesystem::path& file, ImageUse use);

/// The same from memory, as embedded in a glTF file. `name` is for messages.
Image read_image(std::span<const std::byte> bytes, const std::string& name, ImageUse use);

/// What a file's header says; throws as read_image does, as far as headers tell.
ImageInfo read_image_info(const std::filesystem::path& file);

/// The same from memory. `name` is for messages.
ImageInfo read_image_info(std::span<const std::byte> bytes, const std::string& name);

/// What writing may cost: PNG on all threads, TIFF by how it deflates; other formats know no
/// difference. The samples are the same.
///
/// Normal maps as PNG, beside OpenImageIO's defaults, which write 2 to 6 MPixel/s on one thread
/// (bench/README.md): most have the same size within a tenth by any effort, for what prediction
/// leaves over is noise. Where heights came in steps, or change very little, efforts differ.
enum class WriteEffort {
    fast,    ///< 35 to 60 MPixel/s a thread; files up to a quarter larger than OpenImageIO's.
    normal,  ///< 17 to 60 MPixel/s a thread; files at most a tenth larger, mostly smaller.
    small,   ///< 3 to 60 MPixel/s a thread; files of 0.55 to 1 of OpenImageIO's size.
};

/// How an image file is written. No choice but `half` changes what is read back.
struct ImageWriteOptions {
    WriteEffort effort = WriteEffort::normal;
    /// EXR: samples are rounded to the nearest half float (11 significant bits). What lies beyond
    /// the range of half becomes +-65504, its largest number, and is reported as "texel beyond
    /// half's range"; infinities and NaN stay what they are.
    bool half = false;
};

/// Writes a whole image; the format is decided by the extension: .png .tif .tiff .exr .hdr .jpg.
///
/// \param metadata  text entries, kept where the format can hold them: PNG (tEXt), EXR, TIFF (lines
///                  "key=value" of its description, read back where the key begins with "relief:");
///                  keys have 1 to 79 letters
/// \throws FileError if it cannot be written, or if the extension is another
/// \throws InvalidInput if the format cannot hold these samples: float in PNG, anything but 8 bits
///         of 1 or 3 channels in JPEG, anything but float in EXR and HDR, anything but 3 channels
///         in HDR, half in anything but EXR; or if they would read back as something else: linear
///         colour in integers (encode it with to_srgb first), sRGB colour in float
///
/// Written beside and renamed: a failure leaves no half file and the old one unharmed. The same
/// image gives the same bytes, whatever the number of threads. PNG, TIFF and EXR keep every sample
/// (EXR and TIFF as float); HDR keeps 8 bits of precision and no negative values; JPEG is written
/// at quality 95.
void write_image(const std::filesystem::path& file, const Image& image,
                 const std::map<std::string, std::string>& metadata = {},
                 const ImageWriteOptions& options = {});

/// The same; what had to be changed about the samples is added to `report`.
void write_image(const std::filesystem::path& file, const Image& image,
                 const std::map<std::string, std::string>& metadata,
                 const ImageWriteOptions& options, Report& report);

}  // namespace relief
