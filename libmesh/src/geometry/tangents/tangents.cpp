// SPDX-License-Identifier: Apache-2.0
// MikkTSpace's tangents, written from its description [Mikkelsen 2008] and the contract of its
// header. Object space, unit vectors; computed in double, rounded to float once.
//
// Vertices equal in position, normal and texture coordinate are one. Around each, triangles that
// follow each other across edges and whose textures run the same way form a group, whose tangents
// are averaged by the angle of the corner, seen along the normal. Where this departs from the
// reference implementation, on inputs for which that gives no usable or no stable answer, a
// comment says so, here and in the parts. Every fallback is counted.
// Tests: tests/mesh/geometry/tangents/tangents_test.cpp, tangents_golden_test.cpp.
#include "relief/mesh/tangents.h"

#include <fmt/format.h>

#include <algorithm>

#include "geometry/check_triangles.h"
#include "geometry/corners.h"
#include "geometry/direction.h"
#include "geometry/tangents/tangent_fill.h"
#include "geometry/tangents/tangent_groups.h"
#include "geometry/tangents/tangent_signs.h"
#include "geometry/tangents/tangent_vote_blocks.h"
#include "geometry/weld.h"
#include "large_memory.h"
#include "parallel.h"
#include "progress_stage.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

void check(const TangentInput& input) {
    const std::size_t positions = input.positions.size();
    const std::size_t normals = input.normals.size();
    const std::size_t texcoords = input.texcoords.size();
    if (normals != positions) {
        throw InvalidInput(
            fmt::format("there are {} normals, but {} positions", normals, positions));
    }
    if (texcoords != positions) {
        throw InvalidInput(fmt::format("there are {} texture coordinates, but {} positions",
                                       texcoords, positions));
    }
    check_triangles(input.triangles, positions);
}

void report_normals(std::span<const glm::vec3> normals, Report& report) {
    parallel_for_reporting(normals.size(), 16384, report,
                           [&](std::size_t begin, std::size_t end, Report& found) {
                               for (std::size_t v = begin; v < end; ++v) {
                                   if (!is_finite(normals[v]) || normals[v] == glm::vec3(0.0F)) {
                                       found.add("normal without direction", "vertex", v,
                                                 "its tangents follow the texture alone");
                                   }
                               }
                           });
}

void report_triangles(const TriangleGradients& gradients, Report& report) {
    for (const std::uint32_t triangle : gradients.without) {
        switch (gradients.kinds[triangle]) {
            case Gradient::upright:
            case Gradient::mirrored:
                break;
            case Gradient::none:
                report.add("triangle without texture gradient", "triangle", triangle,
                           "takes its neighbours' tangents");
                break;
            case Gradient::coinciding:
                report.add("triangle with coinciding corners", "triangle", triangle,
                           "takes the tangents of triangles at its vertices");
                break;
            case Gradient::non_finite:
                report.add("triangle with non-finite values", "triangle", triangle,
                           "takes the tangents of triangles at its vertices");
                break;
        }
    }
}

void report_groups(const GroupFindings& findings, Report& report) {
    for (const GroupFindings::Repeated& repeated : findings.repeated) {
        report.add("repeated triangle", "triangle", repeated.triangle,
                   "counts once and shares its tangents");
    }
    for (const Corner corner : findings.along_normal) {
        report.add("texture direction along the normal", "corner", corner,
                   "takes the tangent of others at its vertex");
    }
    for (const Corner corner : findings.cancelled)
        report.add("cancelling tangents", "corner", corner, "keeps its own triangle's tangent");
}

/// Triangles over vertices that are all different; nothing is copied where they already are.
class WeldedTriangles {
  public:
    explicit WeldedTriangles(const TangentInput& input) : triangles_(input.triangles) {
        const std::vector<std::uint32_t> first =
            weld_vertices(input.positions, input.normals, input.texcoords);
        std::uint32_t vertex = 0;
        if (std::all_of(first.begin(), first.end(),
                        [&](std::uint32_t index) { return index == vertex++; }))
            return;
        welded_ = welded_triangles(input.triangles, first);
        triangles_ = welded_;
    }
    [[nodiscard]] std::span<const glm::uvec3> get() const { return triangles_; }

  private:
    std::vector<glm::uvec3> welded_;
    std::span<const glm::uvec3> triangles_;
};

std::vector<glm::vec4> tangents_of(TangentInput input, TangentWeight weight, TangentGroups groups,
                                   Report& report) {
    ProgressStage stage("tangents", 6);
    check(input);
    const WeldedTriangles welded(input);
    input.triangles = welded.get();
    stage.advance(1);

    std::vector<glm::vec4> tangents;
    reserve_to_fill(tangents, 3 * input.triangles.size());
    tangents.resize(3 * input.triangles.size());
    const TriangleGradients gradients = cast_votes(input, weight, tangents);
    stage.advance(1);
    const CornersByVertex corners(input.positions.size(), input.triangles,
                                  [&](std::size_t t) { return takes_part(gradients.kinds[t]); });
    stage.advance(1);
    const TriangleSigns signs = triangle_signs(input.triangles, corners, gradients);
    stage.advance(1);
    const GroupInput group_input{input, corners, gradients, signs, groups};
    const GroupFindings findings = average_groups(group_input, tangents);
    stage.advance(1);

    report_normals(input.normals, report);
    report_triangles(gradients, report);
    report_groups(findings, report);
    for (const Corner corner : fill_open_corners(group_input, findings, tangents)) {
        report.add("corner without texture direction", "corner", corner,
                   "gets a fixed tangent perpendicular to its normal");
    }
    return tangents;
}

}  // namespace

std::vector<glm::vec4> mikktspace_tangents(std::span<const glm::vec3> positions,
                                           std::span<const glm::vec3> normals,
                                           std::span<const glm::vec2> texcoords,
                                           std::span<const glm::uvec3> triangles, Report& report) {
    return tangents_of({positions, normals, texcoords, triangles}, TangentWeight::angle,
                       TangentGroups::connected, report);
}

std::vector<glm::vec4> area_weighted_tangents(std::span<const glm::vec3> positions,
                                              std::span<const glm::vec3> normals,
                                              std::span<const glm::vec2> texcoords,
                                              std::span<const glm::uvec3> triangles,
                                              Report& report) {
    return tangents_of({positions, normals, texcoords, triangles}, TangentWeight::area,
                       TangentGroups::connected, report);
}

std::vector<glm::vec4> lengyel_tangents(std::span<const glm::vec3> positions,
                                        std::span<const glm::vec3> normals,
                                        std::span<const glm::vec2> texcoords,
                                        std::span<const glm::uvec3> triangles, Report& report) {
    return tangents_of({positions, normals, texcoords, triangles}, TangentWeight::stretch,
                       TangentGroups::all, report);
}

}  // namespace relief
