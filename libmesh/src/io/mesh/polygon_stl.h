// SPDX-License-Identifier: Apache-2.0
/// \file
/// STL files, ASCII and binary. Tests: tests/mesh/io/mesh/stl_test.cpp.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>

#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"

namespace relief {

/// See read_mesh in mesh_file.h. Several solids in one ASCII file become one mesh.
///
/// Why not OpenMesh's reader: version 9 drops triangles smaller than 1e-38 and those with NaN, and
/// reads files that are cut short or have bytes behind the last triangle as empty ones.
/// \param origin  taken off the positions before they are rounded to float
MeshFile read_stl(const std::filesystem::path& file, const glm::dvec3& origin, Report& report);

}  // namespace relief
