// SPDX-License-Identifier: Apache-2.0
/// \file
/// Opening image files that can be read row by row.
/// Tests: tests/mesh/io/image/image_rows_test.cpp.
#pragma once

#include <filesystem>
#include <memory>

#include "io/image/row_source.h"

namespace relief {

/// The source for a file that can be read by rows; nothing where it has to be read whole.
/// \throws FileError as read_image() does
std::unique_ptr<RowSource> open_streamed_rows(const std::filesystem::path& file);

}  // namespace relief
