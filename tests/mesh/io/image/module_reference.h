// SPDX-License-Identifier: Apache-2.0
/// \file
/// The image module as an independent decoder to compare our own with.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "relief/mesh/image.h"

namespace relief::test {

/// A file that may be of any kind, as bytes.
std::string contents_of(const std::filesystem::path& file);

/// A zlib stream of these bytes.
std::string zlib_stream(const std::string& bytes);

/// Four bytes, the highest first.
inline std::string big32(std::uint32_t value) {
    return {static_cast<char>(value >> 24), static_cast<char>(value >> 16),
            static_cast<char>(value >> 8), static_cast<char>(value)};
}

/// What relief's own decoders make of it; nothing where they leave it to the module.
/// \throws FileError where it is refused before any decoder sees it
std::optional<Image> directly(const std::string& file);

/// What the image module makes of it, which is OpenImageIO with libpng and libjpeg; nothing where
/// it refuses it. \throws FileError as above
std::optional<Image> by_module(const std::string& file);

/// Same size, channels and samples. `what` says which file.
void expect_same(const std::optional<Image>& found, const std::optional<Image>& expected,
                 const std::string& what);

/// How many of the real files with this extension were read directly, all as the module reads
/// them, and how many were left to it.
struct Comparison {
    std::size_t direct = 0;
    std::size_t left = 0;
};
Comparison compare_all(const std::filesystem::path& folder, const std::string& extension);

}  // namespace relief::test
