// SPDX-License-Identifier: Apache-2.0
// Texture coordinates one by one and triangle by triangle, judged as tangents.h judges them; only
// triangles that have an area in space count. Tests: tests/mesh/geometry/health/diagnose_test.cpp.
#include "geometry/direction.h"
#include "geometry/health/diagnose_parts.h"
#include "geometry/tangents/texture_gradient.h"

namespace relief {

void diagnose_texture(const Subject& subject, Tally& tally) {
    const Mesh& mesh = subject.mesh;
    if (mesh.texcoords.empty()) return;
    for (std::size_t v = 0; v < mesh.texcoords.size(); ++v) {
        if (!is_finite(mesh.texcoords[v])) tally.add(MeshCondition::texture_not_finite, v);
    }
    const std::vector<Gradient> gradients =
        gradient_kinds(mesh.positions, mesh.texcoords, mesh.triangles);
    for (std::size_t t = 0; t < gradients.size(); ++t) {
        if (!has_area(subject.shapes[t])) continue;
        if (gradients[t] == Gradient::none) tally.add(MeshCondition::texture_degenerate, t);
        if (gradients[t] == Gradient::mirrored) tally.add(MeshCondition::texture_mirrored, t);
    }
}

}  // namespace relief
