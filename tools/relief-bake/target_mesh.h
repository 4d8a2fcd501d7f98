// SPDX-License-Identifier: Apache-2.0
/// \file
/// The mesh that a map belongs to, with its tangent frames, from a model file.
/// Tests: tests/tools/relief_bake_space_test.cpp.
#pragma once

#include <filesystem>
#include <optional>

#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief::tools {

struct TargetMesh {
    Mesh mesh;
    bool has_own_tangents = false;  ///< All that it has are the file's.
};

/// All triangles of a model in object space, primitive after primitive, with normals and tangents.
///
/// \param tangents  absent: the file's own, and where it has none MikkTSpace's
/// Normals are the file's; where it has none, flat ones for glTF, which asks for that, and averaged
/// by angle for others. Texture coordinates are set 0, or those of a primitive's normal texture.
/// \throws FileError if the file cannot be read, or a primitive has no texture coordinates
TargetMesh read_target_mesh(const std::filesystem::path& file, std::optional<TangentMode> tangents,
                            Report& report);

}  // namespace relief::tools
