// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/conformance_test.cpp.
#include "conformance_judge.h"

#include <cmath>
#include <utility>

#include "relief/mesh/compare.h"
#include "relief/mesh/direction_error.h"

namespace relief::tools {
namespace {

std::uint32_t vertex_at(const Mesh& mesh, std::size_t corner) {
    return mesh.triangles[corner / 3][static_cast<int>(corner % 3)];
}

bool has_area(const Mesh& mesh, std::size_t triangle) {
    const glm::uvec3& t = mesh.triangles[triangle];
    const glm::dvec3 origin(mesh.positions[t.x]);
    return glm::cross(glm::dvec3(mesh.positions[t.y]) - origin,
                      glm::dvec3(mesh.positions[t.z]) - origin) != glm::dvec3(0.0);
}

bool has_one_hand(const Mesh& mesh, std::size_t triangle) {
    const glm::uvec3& t = mesh.triangles[triangle];
    return mesh.tangents[t.x].w == mesh.tangents[t.y].w &&
           mesh.tangents[t.x].w == mesh.tangents[t.z].w;
}

/// What holds for any usable tangent.
void judge_invariant(const KitMesh& kit, std::size_t corner, const glm::vec4& tangent,
                     Judgement& judgement) {
    const double tolerance = tolerance_of(kit.group);
    const glm::dvec3 direction(tangent);
    const double length = glm::length(direction);
    if (!std::isfinite(length)) {
        ++judgement.not_finite;
        return;
    }
    if (std::abs(length - 1.0) > tolerance) ++judgement.not_unit;
    const glm::dvec3 normal(kit.mesh.normals[vertex_at(kit.mesh, corner)]);
    const double cosine = glm::dot(direction, normal) / glm::length(normal);
    if (std::abs(cosine) > tolerance) ++judgement.leaning;
    if (std::abs(tangent.w) != 1.0F) ++judgement.unhanded;
}

}  // namespace

double tolerance_of(KitGroup group) {
    // Conforming tangents may be stored in 16 bits; usable ones are floats that are unit as far as
    // floats can be.
    return group == KitGroup::stability ? 1e-6 : 1e-3;
}

bool Judgement::passes(KitGroup group) const {
    const bool is_usable = missing == 0 && extra == 0 && not_finite == 0 && not_unit == 0 &&
                           leaning == 0 && unhanded == 0 && mixed == 0;
    return is_usable && (group == KitGroup::stability || (other_sign == 0 && too_far == 0));
}

Judgement judge(const KitMesh& kit, const Mesh& theirs) {
    const CornerMatch match = match_corners(kit.mesh, theirs);
    const bool is_compared = kit.group != KitGroup::stability;
    Judgement judgement;
    judgement.corners = 3 * kit.mesh.triangles.size();
    judgement.extra = 3 * match.only_b.size();
    std::vector<float> degrees;
    float worst = -1.0F;
    for (std::size_t corner = 0; corner < judgement.corners; ++corner) {
        const std::uint32_t their_corner = match.corners[corner];
        if (their_corner == no_corner_matched) {
            ++(has_area(kit.mesh, corner / 3) ? judgement.missing : judgement.left_out);
            continue;
        }
        if (is_compared && kit.expected[corner].w == 0.0F) continue;
        ++judgement.judged;
        const glm::vec4& tangent = theirs.tangents[vertex_at(theirs, their_corner)];
        judge_invariant(kit, corner, tangent, judgement);
        if (!has_one_hand(theirs, their_corner / 3)) ++judgement.mixed;
        if (!is_compared) continue;
        const glm::vec4& expected = kit.expected[corner];
        if (tangent.w != expected.w) ++judgement.other_sign;
        const double off = degrees_between(glm::dvec3(tangent), glm::dvec3(expected));
        if (!(off <= conforming_degrees)) ++judgement.too_far;
        if (static_cast<float>(off) > worst) {
            worst = static_cast<float>(off);
            judgement.worst_corner = corner;
        }
        degrees.push_back(static_cast<float>(off));
    }
    judgement.degrees = angle_distribution(std::move(degrees));
    return judgement;
}

}  // namespace relief::tools
