// SPDX-License-Identifier: Apache-2.0
/// \file
/// The image module as an independent decoder, to compare the direct decoders with.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "relief/mesh/image.h"

namespace relief::test {

/// Returns a zlib stream of these bytes.
std::string zlib_stream(const std::string& bytes);

/// Returns four bytes, the highest first.
inline std::string big32(std::uint32_t value) {
    return {static_cast<char>(value >> 24), static_cast<char>(value >> 16),
            static_cast<char>(value >> 8), static_cast<char>(value)};
}

/// Decodes a file with the direct decoders; no value if they leave it to the module.
/// \throws FileError if it is refused before any decoder reads it
std::optional<Image> directly(const std::string& file);

/// Decodes a file with the image module, which is OpenImageIO with libpng and libjpeg; no value if
/// it refuses the file. \throws FileError as above
std::optional<Image> by_module(const std::string& file);

/// Checks that size, channels and samples are equal. `what` names the file.
void expect_same(const std::optional<Image>& found, const std::optional<Image>& expected,
                 const std::string& what);

/// The number of real files with this extension that the direct decoders read, all with the result
/// of the module, and the number left to the module.
struct Comparison {
    std::size_t direct = 0;
    std::size_t left = 0;
};
Comparison compare_all(const std::filesystem::path& folder, const std::string& extension);

}  // namespace relief::test
