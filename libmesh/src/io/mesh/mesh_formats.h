// SPDX-License-Identifier: Apache-2.0
/// \file
/// Readers and writers of the mesh formats, see read_mesh() and write_mesh(). Readers subtract
/// `origin` from the positions before these are rounded to float.
#pragma once

#include <filesystem>
#include <functional>
#include <glm/glm.hpp>

#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"

namespace relief {

MeshFile read_obj(const std::filesystem::path& file, const glm::dvec3& origin, Report& report);

/// Writes materials to a file of the same name with the extension .mtl.
void write_obj(const std::filesystem::path& file, const MeshFile& contents);

/// Vertices keep their number and order, except if texture coordinates are stored per face: corners
/// are then merged into vertices as for OBJ.
///
/// Texture coordinates are s t, u v or texture_u texture_v, with v upwards as Blender, MeshLab and
/// others write them (the format does not specify it); v is flipped. Integer colors, normals and
/// texture coordinates are divided by the largest value of their type.
MeshFile read_ply(const std::filesystem::path& file, const glm::dvec3& origin, Report& report);

/// Texture coordinates are s t with v upwards. Colors are bytes if all of them are multiples of
/// 1/255, otherwise floats.
void write_ply(const std::filesystem::path& file, const MeshFile& contents);

/// Several solids in one ASCII file become one mesh.
///
/// relief does not use OpenMesh 9's reader: it drops triangles smaller than 1e-38 and those with
/// NaN, and reads files that are truncated or have bytes after the last triangle as empty.
MeshFile read_stl(const std::filesystem::path& file, const glm::dvec3& origin, Report& report);

/// Vertices keep their number and order; v is flipped, as for PLY.
///
/// relief does not use OpenMesh 9's reader: after a NaN it repeats old numbers, it trusts any
/// count, and it reads nothing if the counts are on the line of "OFF".
MeshFile read_off(const std::filesystem::path& file, const glm::dvec3& origin, Report& report);

/// One of the readers above.
using MeshReader =
    std::function<MeshFile(const std::filesystem::path&, const glm::dvec3& origin, Report&)>;

/// Reads a file, and reads it again with a local origin if the mesh is farther from 0 than 16 times
/// its size. The second result is used, and reported, if it has digits that floats around 0 cannot
/// hold. Files with float coordinates (binary ones) are not affected.
MeshFile read_with_local_origin(const std::filesystem::path& file, const MeshReader& read,
                                Report& report);

}  // namespace relief
