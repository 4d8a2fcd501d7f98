// SPDX-License-Identifier: Apache-2.0
/// \file
/// What can be said of an encoded image before a decoder sees it: its format by its first bytes,
/// whether it is whole, whether its size is believable, and its text. Pure; knows no library.
///
/// PNG and JPEG are reduced to the parts that define their samples. That keeps gAMA, iCCP, Exif and
/// XMP, which would change or delay decoding (a hostile XMP block takes minutes), from the decoder.
/// Tests: tests/mesh/io/image/image_file_container_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace relief {

/// An encoded image, ready for the module.
struct ImageContainer {
    const char* format = nullptr;     ///< OpenImageIO's name.
    std::vector<std::byte> stripped;  ///< PNG and JPEG: what to decode in place of the input.
    std::map<std::string, std::string> text;  ///< PNG: tEXt and uncompressed iTXt entries.
};

/// Looks at an encoded image.
///
/// \param name  for messages; its extension decides only for TGA, which has no signature
/// \throws FileError if the format is unknown; if a PNG, JPEG or TGA is cut short; or if one
///         announces more samples than its bytes can possibly hold
ImageContainer examine_image(std::span<const std::byte> bytes, const std::filesystem::path& name);

/// OpenImageIO's name for the format that the first bytes of a file (16 are enough) announce, or
/// null.
const char* format_by_signature(std::string_view start);

/// Reads bytes from a place on that lies within a file.
using ReadBytes = std::function<void(std::uint64_t from, std::span<std::byte> to)>;

/// A chunk of a PNG: where it stands, and the size of its data, 8 bytes further on.
struct PngChunkPlace {
    std::uint64_t at = 0;
    std::uint32_t length = 0;
    std::string_view type;
};

/// Goes through the chunks of a PNG up to its end, looking at nothing but lengths and types.
/// \throws FileError if it is cut short
void walk_png(std::uint64_t size, const ReadBytes& read, const std::filesystem::path& name,
              const std::function<void(const PngChunkPlace&)>& visit);

/// Keeps the text of a tEXt or an uncompressed iTXt chunk.
void keep_png_text(std::string_view type, std::string_view data,
                   std::map<std::string, std::string>& text);

/// \param header      the data of IHDR
/// \param compressed  bytes of all IDAT chunks
/// \throws FileError if these cannot hold what the header announces, or the header makes no sense
void check_png_size(std::span<const std::byte> header, std::uint64_t compressed, std::uint64_t size,
                    const std::filesystem::path& name);

/// The same for an EXR file of this size, of which `start` holds the beginning.
/// \return false where that is not enough to tell
bool check_exr(std::span<const std::byte> start, std::uint64_t size,
               const std::filesystem::path& name);

}  // namespace relief
