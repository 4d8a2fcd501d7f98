// SPDX-License-Identifier: Apache-2.0
/// \file
/// Reads the color tags of image files. relief does not use them: ImageUse decides.
#pragma once

#include <filesystem>
#include <string>

namespace relief {

/// Returns the tag by which a program would interpret the samples of a PNG file as colors: "sRGB",
/// "gamma 0.45455", "ICC profile" or "coding-independent code points"; the first one in the file.
/// Empty for a gamma of 1, for files without tags, and for other formats.
/// \throws FileError if the file cannot be read
std::string color_tag(const std::filesystem::path& file);

}  // namespace relief
