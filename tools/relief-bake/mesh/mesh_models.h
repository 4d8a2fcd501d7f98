// SPDX-License-Identifier: Apache-2.0
/// \file
/// The models of a bake, read into one space. Tests: tests/tools/relief_bake_mesh_test.cpp.
#pragma once

#include <filesystem>
#include <optional>

#include "common/findings.h"
#include "relief/mesh/mesh.h"

namespace relief::tools {

/// A model as one mesh, in world space.
struct BakeModel {
    Mesh mesh;
    glm::dvec3 origin{0.0};  ///< Positions are relative to it (mesh_file.h).
    /// Of the only primitive of a glTF file; absent where there are several. Mesh files: none.
    std::optional<glm::dmat3> world_from_object;
};

/// \throws FileError, UsageError
BakeModel read_bake_model(const std::filesystem::path& file, Findings& findings);

/// Makes positions relative to another origin.
void move_to(BakeModel& model, const glm::dvec3& origin);

}  // namespace relief::tools
