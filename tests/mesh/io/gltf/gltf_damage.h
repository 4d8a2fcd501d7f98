// SPDX-License-Identifier: Apache-2.0
/// \file
/// GLB files with wrong bytes in their binary chunk: for showing that damage never leads astray.
#pragma once

#include <filesystem>
#include <random>

namespace relief::test {

/// A copy of a GLB in which one to four random bytes behind its JSON have random values.
void write_damaged_copy(const std::filesystem::path& file, const std::filesystem::path& copy,
                        std::mt19937& random);

/// Whether a file is refused with a FileError; if not, all of its meshes are read (each may be
/// refused with InvalidInput) and the document is written, to go wrong if something can.
bool is_refused(const std::filesystem::path& file);

}  // namespace relief::test
