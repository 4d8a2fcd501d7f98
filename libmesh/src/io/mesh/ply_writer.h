// SPDX-License-Identifier: Apache-2.0
/// \file
/// Writing binary PLY. Tests: tests/mesh/io/mesh/ply_test.cpp.
#pragma once

#include <filesystem>

#include "relief/mesh/mesh_file.h"

namespace relief {

/// See write_mesh in mesh_file.h. Texture coordinates are s t with v upwards; colours are bytes
/// where all of them are multiples of 1/255, else floats.
void write_ply(const std::filesystem::path& file, const MeshFile& contents);

}  // namespace relief
