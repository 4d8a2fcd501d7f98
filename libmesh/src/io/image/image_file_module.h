// SPDX-License-Identifier: Apache-2.0
/// \file
/// Finding and loading the image module, once and at the first need.
/// Tests: tests/mesh/io/image/image_file_test.cpp.
#pragma once

#include <filesystem>

#include "io/image/image_module.h"

namespace relief {

/// The module, loaded now if it was not yet; it stays until the program ends.
///
/// Looked for in $RELIEF_MODULE_DIR, then in ../lib/relief beside the running program. A failure is
/// not remembered: the next call tries again.
///
/// \param file  what it is needed for, for the message
/// \throws FileError if it is in neither place, does not load, or is of another version
const ImageModule& image_module(const std::filesystem::path& file);

}  // namespace relief
