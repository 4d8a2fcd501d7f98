// SPDX-License-Identifier: Apache-2.0
/// \file
/// PLY files, ASCII and binary of either byte order, of any scalar types.
///
/// Why not OpenMesh's reader: version 9 never comes back from some broken headers, takes gigabytes
/// for a negative list length, refuses integer positions and unsigned index types other than its
/// own, and leaves out texture coordinates named texture_u or stored by face.
/// Tests: tests/mesh/io/mesh/ply_test.cpp.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>

#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"

namespace relief {

/// See read_mesh in mesh_file.h. Vertices are kept as they are, in number and order, unless texture
/// coordinates are stored by face: then corners are unified into vertices as in OBJ.
///
/// Texture coordinates are s t, u v or texture_u texture_v, with v upwards, as Blender, MeshLab and
/// others write them (the format itself does not say); v is turned here. Integer colours, normals
/// and texture coordinates are divided by the largest value of their type.
/// \param origin  taken off the positions before they are rounded to float
MeshFile read_ply(const std::filesystem::path& file, const glm::dvec3& origin, Report& report);

}  // namespace relief
