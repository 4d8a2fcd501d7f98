// SPDX-License-Identifier: Apache-2.0
// Texels on the low-poly mesh: interpolated positions and ray directions.
// Tests: tests/mesh/bake/bake_test.cpp, padding_test.cpp.
#include "bake/low_surface.h"

#include <fmt/format.h>

#include <cmath>

#include "geometry/direction.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/report.h"

namespace relief {
namespace {

std::vector<glm::vec3> cage_corners(const Mesh& cage, const Mesh& low) {
    validate(cage);
    if (cage.triangles.size() != low.triangles.size()) {
        throw InvalidInput(fmt::format("the cage has {} triangles, not {} as the low mesh",
                                       cage.triangles.size(), low.triangles.size()));
    }
    std::vector<glm::vec3> positions;
    positions.reserve(3 * cage.triangles.size());
    for (const glm::uvec3& triangle : cage.triangles) {
        for (int i = 0; i < 3; ++i)
            positions.push_back(cage.positions[triangle[i]]);
    }
    return positions;
}

/// Returns the ray directions by vertex: smoothed normals (hard edges ignored), blended with the
/// vertex normals by the hardness. Empty for face normals.
std::vector<glm::vec3> ray_directions(const Mesh& mesh, const BakeOptions& options) {
    if (options.directions == RayDirections::face) return {};
    if (options.directions == RayDirections::shading) return mesh.normals;
    Report ignored;  // Frames and rays report defects of triangles.
    std::vector<glm::vec3> directions =
        vertex_normals(mesh.positions, mesh.triangles, NormalWeight::angle, ignored);
    if (options.hardness == 0.0) return directions;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        directions[i] = rounded(direction_or_zero(
            glm::mix(glm::dvec3(directions[i]), glm::dvec3(mesh.normals[i]), options.hardness)));
    }
    return directions;
}

double sum(const glm::dvec3& v) {
    return v.x + v.y + v.z;
}

/// Returns the inverse of the height of each corner above its opposite edge.
glm::dvec3 inverse_heights(const Mesh& mesh, const glm::uvec3& corners) {
    const glm::dvec3 a(mesh.positions[corners.x]);
    const glm::dvec3 b(mesh.positions[corners.y]);
    const glm::dvec3 c(mesh.positions[corners.z]);
    const double twice_area = glm::length(glm::cross(b - a, c - a));
    return glm::dvec3(glm::distance(b, c), glm::distance(c, a), glm::distance(a, b)) / twice_area;
}

}  // namespace

LowSurface::LowSurface(const Mesh& low, const BakeOptions& options, Report& report) {
    validate(low);
    if (low.texcoords.empty()) throw InvalidInput("the low mesh has no texture coordinates");
    const bool to_tangent =
        options.space == BakeSpace::tangent && (options.layers.normals || options.sample_angle);
    FrameOptions frames;
    frames.tangents = !to_tangent            ? TangentMode::none
                      : low.tangents.empty() ? TangentMode::mikktspace
                                             : TangentMode::keep;
    mesh_ = with_frames(low, frames, report).mesh;
    if (options.cage != nullptr) {
        cage_ = cage_corners(*options.cage, low);
        cage_inside_ = options.max_distance;
    } else {
        directions_ = ray_directions(mesh_, options);
    }
}

double LowSurface::cage_reach() const {
    double reach = 0.0;
    for (std::size_t i = 0; i < cage_.size(); ++i) {
        const std::uint32_t vertex = mesh_.triangles[i / 3][static_cast<int>(i % 3)];
        const double here =
            glm::distance(glm::dvec3(cage_[i]), glm::dvec3(mesh_.positions[vertex]));
        if (std::isfinite(here)) reach = std::max(reach, here);
    }
    return reach;
}

glm::dvec3 LowSurface::interpolated(std::span<const glm::vec3> values,
                                    const CoveredTexel& texel) const {
    const glm::uvec3 corners = mesh_.triangles[texel.triangle];
    const glm::dvec3 weights(texel.weights());
    return weights.x * glm::dvec3(values[corners.x]) + weights.y * glm::dvec3(values[corners.y]) +
           weights.z * glm::dvec3(values[corners.z]);
}

glm::dvec3 LowSurface::direction(const CoveredTexel& texel, std::size_t sample,
                                 Report& report) const {
    if (!directions_.empty()) {
        const glm::dvec3 outward = direction_or_zero(interpolated(directions_, texel));
        if (outward != glm::dvec3(0.0)) return outward;
        report.add("ray without a direction", "texel", sample, "runs along its triangle's normal");
    }
    const glm::uvec3 corners = mesh_.triangles[texel.triangle];
    const glm::dvec3 a(mesh_.positions[corners.x]);
    return direction_or_zero(glm::cross(glm::dvec3(mesh_.positions[corners.y]) - a,
                                        glm::dvec3(mesh_.positions[corners.z]) - a));
}

ProjectionLine LowSurface::line(const CoveredTexel& texel, const BakeDistances& distances,
                                std::size_t sample, Report& report) const {
    ProjectionLine line;
    line.point = interpolated(mesh_.positions, texel);
    line.outside = distances.offset;
    line.inside = distances.max_distance;
    if (has_cage()) {
        const glm::dvec3 weights(texel.weights());
        glm::dvec3 start(0.0);
        for (int i = 0; i < 3; ++i) {
            start +=
                weights[i] *
                glm::dvec3(cage_[3 * std::size_t{texel.triangle} + static_cast<std::size_t>(i)]);
        }
        line.outside = glm::distance(start, line.point);
        line.inside = cage_inside_.value_or(line.outside);
        line.outward = direction_or_zero(start - line.point);
    } else {
        line.outward = direction(texel, sample, report);
    }
    // A line without a direction, or that is not finite, gets a negative length.
    if (!(glm::length(line.outward) > 0.5) || !is_finite(line.point)) {
        report.add("place without a ray", "texel", sample, "missed");
        line = {glm::dvec3(0.0), glm::dvec3(0.0, 0.0, 1.0), -1.0, 0.0};
    }
    return line;
}

std::optional<CoveredTexel> moved_inside(const Mesh& mesh, const CoveredTexel& texel,
                                         double distance) {
    const glm::dvec3 weights(texel.weights());
    glm::dvec3 least = distance * inverse_heights(mesh, mesh.triangles[texel.triangle]);
    if (!std::isfinite(sum(least))) return std::nullopt;
    if (glm::all(glm::greaterThanEqual(weights, least))) return std::nullopt;
    // The distance from an edge is the weight of the opposite corner times that corner's height.
    // Weights that are too small are raised; the others give in proportion to their excess.
    glm::dvec3 moved;
    if (sum(least) >= 1.0) {
        moved = least / sum(least);  // Proportional to the lengths of the edges: the incenter.
    } else {
        const glm::dvec3 excess = glm::max(weights - least, glm::dvec3(0.0));
        moved = least + excess * ((1.0 - sum(least)) / sum(excess));
    }
    CoveredTexel result = texel;
    result.second = static_cast<float>(moved.y);
    result.third = static_cast<float>(moved.z);
    return result;
}

}  // namespace relief
