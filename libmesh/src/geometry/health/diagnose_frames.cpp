// SPDX-License-Identifier: Apache-2.0
// Stored normals and tangents: whether they are directions, of unit length, and face as their
// triangles do. Tests: tests/mesh/geometry/health/diagnose_test.cpp.
#include <cmath>

#include "geometry/direction.h"
#include "geometry/health/diagnose_parts.h"
#include "geometry/unit_tolerance.h"

namespace relief {
namespace {

// A normal that is perpendicular to a triangle up to rounding neither faces it nor opposes it.
constexpr float sidewise = 1e-3F;

// A cosine between normal and tangent that leaves no more of the tangent than 8-bit storage could
// have made up.
constexpr double along_normal = 0.999;

bool is_unit(double length) {
    return std::abs(length - 1.0) <= unit_tolerance;
}

/// Which ways the triangles of a vertex face, as seen from its normal.
struct Facing {
    std::uint8_t before : 1 = 0;  ///< Some triangle faces as the normal does.
    std::uint8_t beside : 1 = 0;  ///< Some triangle is seen from the side.
    std::uint8_t behind : 1 = 0;  ///< Some triangle shows its back.
};

/// Triangles that are too narrow to say which way they face are not asked.
std::vector<Facing> facings_of(const Subject& subject) {
    std::vector<Facing> facings(subject.mesh.positions.size());
    for (std::size_t t = 0; t < subject.shapes.size(); ++t) {
        if (subject.shapes[t] != TriangleShape::sound) continue;
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t vertex = subject.mesh.triangles[t][i];
            const float cosine = glm::dot(subject.normals[t], subject.mesh.normals[vertex]);
            Facing& facing = facings[vertex];
            if (cosine > sidewise)
                facing.before = 1;
            else if (cosine < -sidewise)
                facing.behind = 1;
            else
                facing.beside = 1;
        }
    }
    return facings;
}

void diagnose_normals(const Subject& subject, Tally& tally) {
    const std::vector<Facing> facings = facings_of(subject);
    for (std::size_t v = 0; v < subject.mesh.normals.size(); ++v) {
        const glm::vec3& normal = subject.mesh.normals[v];
        if (!is_finite(normal)) {
            tally.add(MeshCondition::normal_not_finite, v);
            continue;
        }
        if (normal == glm::vec3(0.0F)) {
            tally.add(MeshCondition::normal_zero, v);
            continue;
        }
        if (!is_unit(glm::length(glm::dvec3(normal)))) tally.add(MeshCondition::normal_not_unit, v);
        const Facing facing = facings[v];
        if (facing.behind != 0 && facing.before == 0 && facing.beside == 0)
            tally.add(MeshCondition::normal_opposed, v);
        else if (facing.behind != 0 || facing.beside != 0)
            tally.add(MeshCondition::normal_divided, v);
    }
}

/// The angle between a tangent and the normal of its vertex, where both are directions.
void diagnose_slant(const Mesh& mesh, std::size_t vertex, Tally& tally) {
    if (mesh.normals.empty()) return;
    const glm::dvec3 tangent = direction_or_zero(glm::dvec3(mesh.tangents[vertex]));
    const glm::dvec3 normal = direction_or_zero(glm::dvec3(mesh.normals[vertex]));
    const double cosine = std::abs(glm::dot(tangent, normal));
    if (cosine > along_normal)
        tally.add(MeshCondition::tangent_along_normal, vertex);
    else if (cosine > leaning_tolerance)
        tally.add(MeshCondition::tangent_leaning, vertex);
}

void diagnose_tangents(const Mesh& mesh, Tally& tally) {
    for (std::size_t v = 0; v < mesh.tangents.size(); ++v) {
        const glm::vec4& tangent = mesh.tangents[v];
        if (!is_finite(tangent)) {
            tally.add(MeshCondition::tangent_not_finite, v);
            continue;
        }
        if (!is_unit(glm::length(glm::dvec3(tangent))))
            tally.add(MeshCondition::tangent_not_unit, v);
        if (std::abs(tangent.w) != 1.0F) tally.add(MeshCondition::tangent_unhanded, v);
        diagnose_slant(mesh, v, tally);
    }
}

}  // namespace

void diagnose_frames(const Subject& subject, Tally& tally) {
    if (!subject.mesh.normals.empty()) diagnose_normals(subject, tally);
    diagnose_tangents(subject.mesh, tally);
}

}  // namespace relief
