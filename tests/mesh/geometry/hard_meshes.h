// SPDX-License-Identifier: Apache-2.0
/// \file
/// Small meshes that break naive code, all valid (mesh.h) and with normals and texture coordinates.
#pragma once

#include <string>
#include <vector>

#include "relief/mesh/mesh.h"
#include "support/triangle_orders.h"

namespace relief::test {

struct NamedMesh {
    std::string name;
    Mesh mesh;
};

/// Degenerate, folded, non-manifold, huge, tiny, far away, non-finite, badly textured.
std::vector<NamedMesh> hard_meshes();

/// What tangents.h promises for any input (broken_tangents).
void expect_tangent_invariants(const Mesh& mesh, const std::vector<glm::vec4>& tangents);

}  // namespace relief::test
