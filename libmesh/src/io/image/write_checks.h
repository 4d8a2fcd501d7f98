// SPDX-License-Identifier: Apache-2.0
/// \file
/// What image formats can hold, checked before anything is written.
/// Tests: tests/mesh/io/image/image_file_test.cpp.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "relief/mesh/image_rows.h"

namespace relief {

/// OpenImageIO's name for the format that an extension asks for. \throws FileError if it is another
const char* format_by_extension(const std::filesystem::path& file);

/// Refuses what would be lost, or would read back as something else. \throws InvalidInput
void check_writable(const std::string& format, const ImageShape& shape,
                    const ImageWriteOptions& options);

/// \throws InvalidInput if a key is empty or longer than PNG can hold
void check_metadata(const std::map<std::string, std::string>& metadata);

}  // namespace relief
