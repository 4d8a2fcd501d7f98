// SPDX-License-Identifier: Apache-2.0
/// \file
/// Rows of PNG files. Tests: tests/mesh/io/image/image_rows_test.cpp.
#pragma once

#include <filesystem>
#include <memory>

#include "io/image/row_source.h"

namespace relief {

/// A PNG file that is plain (png_decoder.h), read as it is asked for; nothing where it is of
/// another kind. Damage that is met on the way is left to the image module to judge, which then
/// reads the file from its beginning. \throws FileError if it is cut short, or announces more than
/// it can hold
std::unique_ptr<RowSource> open_png_rows(const std::filesystem::path& file);

}  // namespace relief
