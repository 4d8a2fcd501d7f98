// SPDX-License-Identifier: Apache-2.0
/// \file
/// Reading a whole file into memory, with an error that says why it could not be done.
/// Tests: tests/mesh/io/mesh/mesh_file_test.cpp.
#pragma once

#include <filesystem>
#include <string>

namespace relief {

/// The bytes of a file, as text. \throws FileError if it is missing, a folder or unreadable
std::string read_file(const std::filesystem::path& file);

/// An extension in lower case with its dot, ".obj"; empty where there is none.
std::string lower_extension(const std::filesystem::path& file);

}  // namespace relief
