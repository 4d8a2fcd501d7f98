// SPDX-License-Identifier: Apache-2.0
// First each of the program's triangles is matched with one of the kit's, then corner is compared
// with corner. Tests: tests/tools/conformance_test.cpp.
#include "conformance_judge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "relief/mesh/direction_error.h"

namespace relief::tools {
namespace {

/// Position and texture coordinates as numbers: -0 is 0.
using CornerKey = std::array<float, 5>;
using TriangleKey = std::array<CornerKey, 3>;

std::uint32_t vertex_at(const Mesh& mesh, std::size_t corner) {
    return mesh.triangles[corner / 3][static_cast<int>(corner % 3)];
}

CornerKey key_of(const Mesh& mesh, std::size_t corner) {
    const std::uint32_t v = vertex_at(mesh, corner);
    const glm::vec3 p = mesh.positions[v] + 0.0F;
    const glm::vec2 t = mesh.texcoords[v] + 0.0F;
    return {p.x, p.y, p.z, t.x, t.y};
}

/// A triangle begun at the corner that comes first by value, so that its beginning does not matter.
struct Rotated {
    TriangleKey key;
    std::array<std::size_t, 3> corners;
};

Rotated rotated(const Mesh& mesh, std::size_t triangle) {
    std::optional<Rotated> first;
    for (std::size_t begin = 0; begin < 3; ++begin) {
        Rotated one{};
        for (std::size_t i = 0; i < 3; ++i) {
            one.corners[i] = 3 * triangle + (begin + i) % 3;
            one.key[i] = key_of(mesh, one.corners[i]);
        }
        if (!first || one.key < first->key) first = one;
    }
    return *first;
}

/// The corners of the kit's mesh and, for each, the program's; absent where there is none.
class Matching {
  public:
    Matching(const Mesh& kit, const Mesh& theirs) : theirs_of_(3 * kit.triangles.size()) {
        std::multimap<TriangleKey, std::array<std::size_t, 3>> open;
        for (std::size_t t = 0; t < kit.triangles.size(); ++t) {
            const Rotated triangle = rotated(kit, t);
            open.emplace(triangle.key, triangle.corners);
        }
        for (std::size_t t = 0; t < theirs.triangles.size(); ++t) {
            const Rotated triangle = rotated(theirs, t);
            const auto [begin, end] = open.equal_range(triangle.key);
            const auto distance = [&](const auto& entry) {
                double sum = 0.0;
                for (std::size_t i = 0; i < 3; ++i)
                    sum += glm::distance(
                        glm::dvec3(kit.normals[vertex_at(kit, entry.second[i])]),
                        glm::dvec3(theirs.normals[vertex_at(theirs, triangle.corners[i])]));
                return sum;
            };
            const auto best = std::min_element(begin, end, [&](const auto& a, const auto& b) {
                return distance(a) < distance(b);
            });
            if (best == end) {
                extra_ += 3;
                continue;
            }
            for (std::size_t i = 0; i < 3; ++i)
                theirs_of_[best->second[i]] = triangle.corners[i];
            open.erase(best);
        }
    }

    [[nodiscard]] std::optional<std::size_t> theirs_of(std::size_t corner) const {
        return theirs_of_[corner];
    }
    [[nodiscard]] std::size_t extra() const { return extra_; }

  private:
    std::vector<std::optional<std::size_t>> theirs_of_;
    std::size_t extra_ = 0;
};

bool has_area(const Mesh& mesh, std::size_t triangle) {
    const glm::uvec3& t = mesh.triangles[triangle];
    const glm::dvec3 origin(mesh.positions[t.x]);
    return glm::cross(glm::dvec3(mesh.positions[t.y]) - origin,
                      glm::dvec3(mesh.positions[t.z]) - origin) != glm::dvec3(0.0);
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

struct Offence {
    double degrees = 0.0;
    std::size_t corner = 0;
};

void sum_up(std::vector<Offence>& angles, Judgement& judgement) {
    if (angles.empty()) return;
    std::stable_sort(angles.begin(), angles.end(),
                     [](const Offence& a, const Offence& b) { return a.degrees < b.degrees; });
    for (const Offence& angle : angles)
        judgement.mean_degrees += angle.degrees / static_cast<double>(angles.size());
    judgement.p99_degrees = angles[(angles.size() * 99 + 99) / 100 - 1].degrees;
    judgement.max_degrees = angles.back().degrees;
    judgement.worst_corner = angles.back().corner;
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
    const Matching matching(kit.mesh, theirs);
    Judgement judgement;
    judgement.corners = 3 * kit.mesh.triangles.size();
    judgement.extra = matching.extra();
    std::vector<Offence> angles;
    for (std::size_t corner = 0; corner < judgement.corners; ++corner) {
        const std::optional<std::size_t> their_corner = matching.theirs_of(corner);
        if (!their_corner) {
            ++(has_area(kit.mesh, corner / 3) ? judgement.missing : judgement.left_out);
            continue;
        }
        const bool is_compared = kit.group != KitGroup::stability;
        if (is_compared && kit.expected[corner].w == 0.0F) continue;
        ++judgement.judged;
        const glm::vec4& tangent = theirs.tangents[vertex_at(theirs, *their_corner)];
        judge_invariant(kit, corner, tangent, judgement);
        const std::size_t first = *their_corner / 3 * 3;
        for (std::size_t i = first; i < first + 3; ++i) {
            if (theirs.tangents[vertex_at(theirs, i)].w == tangent.w) continue;
            ++judgement.mixed;
            break;
        }
        if (!is_compared) continue;
        const glm::vec4& expected = kit.expected[corner];
        if (tangent.w != expected.w) ++judgement.other_sign;
        const double degrees = degrees_between(glm::dvec3(tangent), glm::dvec3(expected));
        if (!(degrees <= conforming_degrees)) ++judgement.too_far;
        if (std::isfinite(degrees)) angles.push_back({degrees, corner});
    }
    sum_up(angles, judgement);
    return judgement;
}

}  // namespace relief::tools
