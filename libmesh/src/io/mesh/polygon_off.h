// SPDX-License-Identifier: Apache-2.0
/// \file
/// OFF files in text form, with normals, colours and texture coordinates.
/// Tests: tests/mesh/io/mesh/off_test.cpp.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>

#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"

namespace relief {

/// See read_mesh in mesh_file.h. Vertices are kept as they are; v is upwards in the file, as in
/// PLY.
///
/// Why not OpenMesh's reader: version 9 fills the rest of the file with stale numbers after a NaN,
/// believes any count, and finds nothing if the counts stand behind "OFF".
/// \param origin  taken off the positions before they are rounded to float
MeshFile read_off(const std::filesystem::path& file, const glm::dvec3& origin, Report& report);

}  // namespace relief
