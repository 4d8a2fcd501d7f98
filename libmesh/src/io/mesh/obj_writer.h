// SPDX-License-Identifier: Apache-2.0
/// \file
/// Writing OBJ with MTL. Tests: tests/mesh/io/mesh/obj_test.cpp.
#pragma once

#include <filesystem>

#include "relief/mesh/mesh_file.h"

namespace relief {

/// See write_mesh in mesh_file.h; materials go to a file of the same name with the extension .mtl.
void write_obj(const std::filesystem::path& file, const MeshFile& contents);

}  // namespace relief
