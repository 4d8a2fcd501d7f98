// SPDX-License-Identifier: Apache-2.0
/// \file
/// The meshes of the conformance kit: small, each about one thing that tangents have to get right.
///
/// Object space, triangles, normals and texture coordinates (upper left origin, v down).
/// Everything is made here from formulas and a fixed generator of random numbers; nothing depends
/// on how relief computes normals or tangents. Tests: tests/tools/conformance_kit_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "relief/mesh/mesh.h"

namespace relief::conformance {

/// What a mesh is judged by.
enum class Group {
    conformance,  ///< Corner by corner against the reference, where that has one answer.
    defect,       ///< The same, but the reference is wrong: expected is what it means to do.
    stability,    ///< Input on which programs fail: only what any usable tangent is.
};

struct KitMesh {
    std::string name;
    Group group;
    std::string about;  ///< One sentence.
    Mesh mesh;
    std::vector<glm::uvec4> quads;  ///< Where the triangles come from quads; else empty.
    bool is_indexed = true;         ///< Else the file has three vertices for each triangle.
};

/// All of them. The same bits on every run.
std::vector<KitMesh> kit_meshes();

/// "conformance", "defect", "stability"
std::string name_of(Group group);

}  // namespace relief::conformance
