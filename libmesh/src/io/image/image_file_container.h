// SPDX-License-Identifier: Apache-2.0
/// Checks of an encoded image before decoding: its format from the first bytes, whether it is
/// complete and its size plausible, and its text. No library is needed.
///
/// PNG and JPEG are reduced to the parts that define their samples. The decoder thus never sees
/// gAMA, iCCP, Exif and XMP, which would change or delay decoding (a hostile XMP block takes
/// minutes).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "relief/mesh/image.h"

namespace relief::detail {

/// An encoded image, ready for the module.
struct ImageContainer {
    const char* format = nullptr;     ///< OpenImageIO's name, or "ktx2".
    std::vector<std::byte> stripped;  ///< PNG and JPEG: the bytes to decode instead of the input.
    std::map<std::string, std::string> text;  ///< PNG: tEXt and uncompressed iTXt entries.
};

/// Examines an encoded image.
///
/// \param name  for messages; its extension matters only for TGA, which has no signature
/// \throws FileError if the format is unknown, if a PNG, JPEG or TGA is truncated, or if a header
///         announces more samples than the bytes can hold
ImageContainer examine_image(std::span<const std::byte> bytes, const std::filesystem::path& name);

/// OpenImageIO's name for the format with these first bytes (16 are enough), "ktx2", or null.
const char* format_by_signature(std::string_view start);

/// Reads bytes of a file from an offset; the range must be inside the file.
using ReadBytes = std::function<void(std::uint64_t from, std::span<std::byte> to)>;

/// A chunk of a PNG: its offset, and the size of its data, which begins 8 bytes later.
struct PngChunkPlace {
    std::uint64_t at = 0;
    std::uint32_t length = 0;
    std::string_view type;
};

/// Visits the chunks of a PNG up to its end. Only lengths and types are read.
/// \throws FileError if the file is truncated
void walk_png(std::uint64_t size, const ReadBytes& read, const std::filesystem::path& name,
              const std::function<void(const PngChunkPlace&)>& visit);

/// Stores the text of a tEXt or an uncompressed iTXt chunk.
void keep_png_text(std::string_view type, std::string_view data,
                   std::map<std::string, std::string>& text);

/// Checks the header of a PNG.
///
/// \param header      the data of IHDR
/// \param compressed  bytes of all IDAT chunks
/// \throws FileError if the header is invalid or announces more than these bytes can hold
void check_png_size(std::span<const std::byte> header, std::uint64_t compressed, std::uint64_t size,
                    const std::filesystem::path& name);

/// Checks the header of an EXR file of this size; `start` has its first bytes.
/// \return false if these are not enough
bool check_exr(std::span<const std::byte> start, std::uint64_t size,
               const std::filesystem::path& name);

/// Decodes common PNG and JPEG files without the image module, which takes 0.2 s to load; nullopt
/// for other kinds and damaged files, which are left to the module. The caller sets the color
/// space.
/// \throws FileError if the image exceeds a limit of the process
std::optional<Image> read_directly(const ImageContainer& container,
                                   const std::filesystem::path& name);

}  // namespace relief::detail
