// SPDX-License-Identifier: Apache-2.0
/// \file
/// The meshes of the conformance kit. Each is small and tests one property of tangents.
///
/// Object space, triangles, normals and texture coordinates (upper left origin, v down). The meshes
/// are computed from formulas and pseudo-random numbers, independently of relief's normals and
/// tangents. Tests: tests/tools/conformance_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "relief-mesh/conformance.h"
#include "relief/mesh/mesh.h"

namespace relief::conformance {

using tools::KitGroup;

struct KitMesh {
    std::string name;
    KitGroup group;
    std::string about;  ///< One sentence.
    Mesh mesh;
    std::vector<glm::uvec4> quads;  ///< Empty if the mesh does not consist of quads.
    bool is_indexed = true;         ///< Otherwise the file has three vertices per triangle.
};

/// All meshes of the kit. Every run computes the same bits.
std::vector<KitMesh> kit_meshes();

}  // namespace relief::conformance
