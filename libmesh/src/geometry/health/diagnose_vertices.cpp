// SPDX-License-Identifier: Apache-2.0
// Positions one by one, and whether any triangle gives them a normal.
// Tests: tests/mesh/geometry/health/diagnose_test.cpp.
#include "geometry/direction.h"
#include "geometry/health/diagnose_parts.h"

namespace relief {
namespace {

/// The most that any triangle does for a position class.
enum class Use : std::uint8_t { none, without_area, with_area };

std::vector<Use> uses_of(const Subject& subject) {
    std::vector<Use> uses(subject.classes.size(), Use::none);
    for (std::size_t t = 0; t < subject.triangles.size(); ++t) {
        const Use use = has_area(subject.shapes[t]) ? Use::with_area : Use::without_area;
        for (int i = 0; i < 3; ++i) {
            Use& most = uses[subject.triangles[t][i]];
            if (most < use) most = use;
        }
    }
    return uses;
}

}  // namespace

void diagnose_vertices(const Subject& subject, Tally& tally) {
    const std::vector<Use> uses = uses_of(subject);
    for (std::size_t v = 0; v < subject.classes.size(); ++v) {
        const Use use = uses[subject.classes[v]];
        if (!is_finite(subject.mesh.positions[v]))
            tally.add(MeshCondition::vertex_not_finite, v);
        else if (use == Use::none)
            tally.add(MeshCondition::vertex_isolated, v);
        else if (use == Use::without_area)
            tally.add(MeshCondition::vertex_voiceless, v);
    }
}

}  // namespace relief
