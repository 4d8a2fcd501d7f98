// SPDX-License-Identifier: Apache-2.0
// Vertices are split where fans meet; then normals are averaged as for any mesh.
// Tests: tests/mesh/geometry/normals/corner_normals_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <utility>

#include "geometry/check_triangles.h"
#include "geometry/corners.h"
#include "geometry/normals/averaged_normals.h"
#include "geometry/normals/normal_sums.h"
#include "geometry/normals/smooth_fans.h"
#include "relief/mesh/error.h"
#include "relief/mesh/normals.h"

namespace relief {
namespace {

void check(const HardEdges& hard_edges, std::size_t triangle_count) {
    const auto& angle = hard_edges.crease_angle;
    if (angle && !(*angle >= 0.0 && *angle <= std::numbers::pi)) {
        throw InvalidInput(
            fmt::format("the crease angle is {} radians, but must be 0 to pi", *angle));
    }
    const std::size_t groups = hard_edges.smoothing_groups.size();
    if (groups != 0 && groups != triangle_count) {
        throw InvalidInput(
            fmt::format("there are {} smoothing groups, but {} triangles", groups, triangle_count));
    }
}

/// Triangles over the first vertex at each place.
std::vector<glm::uvec3> over_places(std::span<const glm::uvec3> triangles, std::size_t vertex_count,
                                    const Groups& shared) {
    std::vector<std::uint32_t> place(vertex_count);
    std::iota(place.begin(), place.end(), 0U);
    for (std::size_t g = 0; g < shared.count(); ++g) {
        for (const std::uint32_t member : shared.at(g))
            place[member] = shared.at(g).front();
    }
    return welded_triangles(triangles, place);
}

/// A mesh in which no two fans share a vertex.
struct FanMesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    std::vector<std::uint32_t> vertex;  ///< Of the mesh it was made from.
    Groups fans;                        ///< Vertices of one fan, where it has several.
};

FanMesh mesh_of(const SmoothFans& fans, std::span<const glm::vec3> positions,
                std::span<const glm::uvec3> triangles) {
    // Vertices of a fan need not be at the same position: welding has a tolerance.
    using FanVertex = std::pair<std::uint32_t, std::uint32_t>;
    std::vector<FanVertex> vertices;
    vertices.reserve(fans.fan_of_corner.size());
    for (std::size_t c = 0; c < fans.fan_of_corner.size(); ++c) {
        vertices.emplace_back(fans.fan_of_corner[c], vertex_of(static_cast<Corner>(c), triangles));
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());

    FanMesh mesh;
    std::vector<std::uint32_t> first_of_fan(vertices.size());
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
        mesh.positions.push_back(positions[vertices[i].second]);
        mesh.vertex.push_back(vertices[i].second);
        const bool goes_on = i > 0 && vertices[i].first == vertices[i - 1].first;
        first_of_fan[i] = goes_on ? first_of_fan[i - 1] : i;
    }
    mesh.fans = groups_of(first_of_fan);
    mesh.triangles.resize(triangles.size());
    for (std::size_t c = 0; c < fans.fan_of_corner.size(); ++c) {
        const FanVertex wanted(fans.fan_of_corner[c], vertex_of(static_cast<Corner>(c), triangles));
        const auto found = std::lower_bound(vertices.begin(), vertices.end(), wanted);
        mesh.triangles[c / 3][static_cast<int>(c % 3)] =
            static_cast<std::uint32_t>(found - vertices.begin());
    }
    return mesh;
}

}  // namespace

CornerNormals corner_normals(std::span<const glm::vec3> positions,
                             std::span<const glm::uvec3> triangles,
                             std::optional<NormalWeight> weight, const NormalOptions& options,
                             const HardEdges& hard_edges, Report& report) {
    check_triangles(triangles, positions.size());
    check(hard_edges, triangles.size());
    const Groups shared = sharing_vertices(positions, options.weld_tolerance);
    const FanMesh fans =
        mesh_of(smooth_fans(positions.size(), over_places(triangles, positions.size(), shared),
                            normals_or_zero(positions, triangles), hard_edges),
                positions, triangles);
    const auto by_fan = [&] { return fans.fans; };
    const AveragedNormals averaged =
        weight
            ? averaged_normals(fans.positions, fans.triangles, *weight, options.arithmetic, by_fan)
            : averaged_normals_by_choice(fans.positions, fans.triangles, options.arithmetic,
                                         fans.fans);

    report_triangles(positions, triangles, averaged.odd_triangles,
                     "has no say in its vertices' normals", report);
    for (const auto& [vertex, kind] : averaged.troubles)
        report_vertex(kind, fans.vertex[vertex], report);
    CornerNormals result;
    result.by_area = averaged.by_area;
    result.normals.reserve(3 * triangles.size());
    for (const glm::uvec3& triangle : fans.triangles) {
        for (int i = 0; i < 3; ++i)
            result.normals.push_back(averaged.normals[triangle[i]]);
    }
    return result;
}

}  // namespace relief
