// SPDX-License-Identifier: Apache-2.0
// MikkTSpace's tangents, written from its description [Mikkelsen 2008] and the contract of its
// header. Object space, unit vectors; computed in double, rounded to float once.
//
// Vertices equal in position, normal and texture coordinate are one. Around each, triangles that
// follow each other across edges and whose textures run the same way form a group, whose tangents
// are averaged by the angle of the corner, seen along the normal. Where this departs from the
// reference implementation, on inputs for which that gives no usable or no stable answer, a
// comment says so, here and in the parts. Every fallback is counted.
// Tests: tests/mesh/geometry/tangents_test.cpp, tangents_golden_test.cpp.
#include "relief/mesh/tangents.h"

#include <fmt/format.h>

#include "geometry/check_triangles.h"
#include "geometry/corner_links.h"
#include "geometry/corners.h"
#include "geometry/direction.h"
#include "geometry/tangent_fill.h"
#include "geometry/tangent_groups.h"
#include "geometry/texture_gradient.h"
#include "geometry/weld.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

void check_lengths(std::size_t positions, std::size_t normals, std::size_t texcoords) {
    if (normals != positions) {
        throw InvalidInput(
            fmt::format("there are {} normals, but {} positions", normals, positions));
    }
    if (texcoords != positions) {
        throw InvalidInput(fmt::format("there are {} texture coordinates, but {} positions",
                                       texcoords, positions));
    }
}

void report_normals(std::span<const glm::vec3> normals, Report& report) {
    for (std::size_t v = 0; v < normals.size(); ++v) {
        if (direction_or_zero(glm::dvec3(normals[v])) == glm::dvec3(0.0)) {
            report.add("normal without direction", "vertex", v,
                       "its tangents follow the texture alone");
        }
    }
}

void report_triangles(std::span<const Gradient> kinds, std::span<const std::uint32_t> twins,
                      Report& report) {
    for (std::size_t t = 0; t < kinds.size(); ++t) {
        switch (kinds[t]) {
            case Gradient::upright:
            case Gradient::mirrored:
                break;
            case Gradient::none:
                report.add("triangle without texture gradient", "triangle", t,
                           "takes its neighbours' tangents");
                break;
            case Gradient::coinciding:
                report.add("triangle with coinciding corners", "triangle", t,
                           "takes the tangents of triangles at its vertices");
                break;
            case Gradient::non_finite:
                report.add("triangle with non-finite values", "triangle", t,
                           "takes the tangents of triangles at its vertices");
                break;
        }
        if (twins[t] != t) {
            report.add("repeated triangle", "triangle", t, "counts once and shares its tangents");
        }
    }
}

}  // namespace

std::vector<glm::vec4> mikktspace_tangents(std::span<const glm::vec3> positions,
                                           std::span<const glm::vec3> normals,
                                           std::span<const glm::vec2> texcoords,
                                           std::span<const glm::uvec3> triangles, Report& report) {
    check_lengths(positions.size(), normals.size(), texcoords.size());
    check_triangles(triangles, positions.size());

    const std::vector<glm::uvec3> welded =
        welded_triangles(triangles, weld_vertices(positions, normals, texcoords));
    const TriangleGradients gradients = triangle_gradients(positions, texcoords, welded);
    const CornersByVertex corners(positions.size(), welded,
                                  [&](std::size_t t) { return takes_part(gradients.kinds[t]); });
    const CornerLinks links = link_corners(welded, corners, gradients.kinds);
    const TangentInput input{positions, normals, welded, corners, links, gradients};
    const std::vector<std::int8_t> signs = triangle_signs(input);
    CornerTangents tangents = grouped_tangents(input, signs);

    report_normals(normals, report);
    report_triangles(gradients.kinds, links.twin, report);
    fill_open_corners(input, signs, tangents, report);
    return std::move(tangents.values);
}

}  // namespace relief
