// SPDX-License-Identifier: Apache-2.0
// Triangles one by one: whether they have an area, and which way they face. Edges in double, so
// that no scale of a float overflows or vanishes. Tests:
// tests/mesh/geometry/health/diagnose_test.cpp.
#include <algorithm>

#include "geometry/direction.h"
#include "geometry/health/diagnose_parts.h"
#include "geometry/weld.h"
#include "parallel.h"

namespace relief {
namespace {

// Width by longest edge. The first is the limit of normals.h. At the second, the rounding of a
// float (6e-8) turns the normal by 0.03 degrees.
constexpr double collinear_width = 1e-12;
constexpr double needle_width = 1e-4;

TriangleShape shape_of(const glm::uvec3& classes, const glm::vec3 (&corners)[3],
                       glm::vec3& normal) {
    normal = glm::vec3(0.0F);
    for (const glm::vec3& corner : corners) {
        if (!is_finite(corner)) return TriangleShape::not_finite;
    }
    if (classes.x == classes.y || classes.y == classes.z || classes.z == classes.x)
        return TriangleShape::collapsed;
    const glm::dvec3 a = glm::dvec3(corners[1]) - glm::dvec3(corners[0]);
    const glm::dvec3 b = glm::dvec3(corners[2]) - glm::dvec3(corners[0]);
    const glm::dvec3 c = b - a;
    const glm::dvec3 area = glm::cross(a, b);
    const double size = glm::length(area);
    const double longest = std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(c, c)});
    if (!(size > collinear_width * longest)) return TriangleShape::collinear;
    normal = glm::vec3(area / size);
    return size > needle_width * longest ? TriangleShape::sound : TriangleShape::needle;
}

}  // namespace

Subject::Subject(const Mesh& subject)
    : mesh(subject),
      classes(weld_positions(mesh.positions)),
      triangles(welded_triangles(mesh.triangles, classes)),
      shapes(triangles.size()),
      normals(triangles.size()) {
    parallel_for(triangles.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const glm::uvec3& corners = triangles[t];
            shapes[t] = shape_of(
                corners,
                {mesh.positions[corners.x], mesh.positions[corners.y], mesh.positions[corners.z]},
                normals[t]);
        }
    });
}

void diagnose_triangles(const Subject& subject, Tally& tally) {
    for (std::size_t t = 0; t < subject.shapes.size(); ++t) {
        switch (subject.shapes[t]) {
            case TriangleShape::sound:
                break;
            case TriangleShape::needle:
                tally.add(MeshCondition::triangle_needle, t);
                break;
            case TriangleShape::collinear:
                tally.add(MeshCondition::triangle_collinear, t);
                break;
            case TriangleShape::collapsed:
                tally.add(MeshCondition::triangle_collapsed, t);
                break;
            case TriangleShape::not_finite:
                tally.add(MeshCondition::triangle_not_finite, t);
                break;
        }
    }
}

}  // namespace relief
