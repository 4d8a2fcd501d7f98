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
#include <filesystem>
#include <map>
#include <span>
#include <string>
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

}  // namespace relief
