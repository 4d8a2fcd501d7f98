// SPDX-License-Identifier: Apache-2.0
/// \file
/// What image files say of the colours in them. relief follows none of it: ImageUse decides.
/// Tests: tests/mesh/io/image/image_tags_test.cpp.
#pragma once

#include <filesystem>
#include <string>

namespace relief {

/// The tag by which a program would take the samples of a PNG file for colours: "sRGB", "gamma
/// 0.45455", "ICC profile", "coding-independent code points"; the first of these. Empty for a gamma
/// of 1, for files without any, and for other formats.
/// \throws FileError if the file cannot be read
std::string color_tag(const std::filesystem::path& file);

}  // namespace relief
