// SPDX-License-Identifier: Apache-2.0
/// \file
/// MTL files. The only home of tinyobjloader. Tests: tests/mesh/io/mesh/obj_test.cpp.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"

namespace relief {

/// The materials that an OBJ file names, in that order, as its MTL files define them.
///
/// \param names      as after usemtl
/// \param libraries  as after mtllib: a file name, which may hold blanks, or several names;
///                   relative to the folder of `file`
/// \param report     counts MTL files that are missing or unreadable, and names that none of them
///                   defines: such a material has its name and default values
std::vector<MtlMaterial> read_materials(const std::filesystem::path& file,
                                        const std::vector<std::string>& names,
                                        const std::vector<std::string>& libraries, Report& report);

}  // namespace relief
