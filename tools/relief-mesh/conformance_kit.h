// SPDX-License-Identifier: Apache-2.0
/// \file
/// The conformance kit as files: its list, its meshes and what is expected of their tangents.
/// conformance/README.md says what they hold. Tests: tests/tools/conformance_test.cpp.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "relief/mesh/mesh.h"

namespace relief::tools {

/// What a mesh is judged by.
enum class KitGroup {
    conformance,  ///< Corner by corner against the reference, where that has one answer.
    defect,     ///< The same, where the reference does what it does not mean to: told, not judged.
    stability,  ///< Only by what any usable tangent is.
};

struct KitMesh {
    std::string name;
    KitGroup group = KitGroup::conformance;
    std::string about;
    Mesh mesh;
    /// Three per triangle, glTF's convention; w is 0 where the corner is not judged. None in the
    /// stability group.
    std::vector<glm::vec4> expected;
};

/// \param folder  holds kit.json, NAME.glb and, outside of the stability group, NAME.f32
/// \throws FileError if something is missing or not as the README says
std::vector<KitMesh> read_kit(const std::filesystem::path& folder);

/// All triangles of a glTF file as one mesh in object space, with their normals and tangents as
/// they are stored (zeros where there are none).
/// \throws FileError if it cannot be read
Mesh read_triangles(const std::filesystem::path& file);

}  // namespace relief::tools
