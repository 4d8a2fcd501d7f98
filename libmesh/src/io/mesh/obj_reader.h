// SPDX-License-Identifier: Apache-2.0
/// \file
/// OBJ files with their MTL. Tests: tests/mesh/io/mesh/obj_test.cpp.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>

#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"

namespace relief {

/// See read_mesh in mesh_file.h.
/// \param origin  taken off the positions before they are rounded to float
MeshFile read_obj(const std::filesystem::path& file, const glm::dvec3& origin, Report& report);

}  // namespace relief
