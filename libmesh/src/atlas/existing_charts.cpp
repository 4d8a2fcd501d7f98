// SPDX-License-Identifier: Apache-2.0
#include "atlas/existing_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "atlas/atlas_stats.h"
#include "progress_stage.h"

namespace relief::detail {
namespace {

/// The coordinates of the corners of all faces in texels, y up.
std::vector<glm::dvec2> corner_points(const AtlasSurface& surface, const Mesh& mesh,
                                      const glm::ivec2& size) {
    std::vector<glm::dvec2> result;
    result.reserve(surface.opposite.size());
    for (const std::uint32_t triangle : triangles_of_faces(surface)) {
        for (std::uint32_t i = 0; i < 3; ++i) {
            const std::uint32_t corner = (i + surface.first_corner[triangle]) % 3;
            const std::uint32_t vertex =
                mesh.triangles[triangle][static_cast<glm::length_t>(corner)];
            const glm::dvec2 texcoord(mesh.texcoords[vertex]);
            if (!std::isfinite(texcoord.x) || !std::isfinite(texcoord.y))
                throw InvalidInput(
                    fmt::format("the texture coordinate of vertex {} is not finite", vertex));
            result.push_back(glm::dvec2(texcoord.x, -texcoord.y) * glm::dvec2(size));
        }
    }
    return result;
}

/// The signed area of a chart; negative if it is mirrored.
double signed_area(const FlatChart& chart) {
    double sum = 0.0;
    for (const glm::uvec3& v : chart.mesh.vertices) {
        const glm::dvec2 a = chart.coordinates[v.y] - chart.coordinates[v.x];
        const glm::dvec2 b = chart.coordinates[v.z] - chart.coordinates[v.x];
        sum += 0.5 * (a.x * b.y - a.y * b.x);
    }
    return sum;
}

/// Shifts a chart, so that its box begins at the origin.
void shift_to_origin(FlatChart& chart) {
    glm::dvec2 low(std::numeric_limits<double>::infinity());
    glm::dvec2 high(-std::numeric_limits<double>::infinity());
    for (const glm::dvec2& each : chart.coordinates) {
        low = glm::min(low, each);
        high = glm::max(high, each);
    }
    for (glm::dvec2& each : chart.coordinates)
        each -= low;
    chart.size = high - low;
}

}  // namespace

std::vector<std::vector<std::uint32_t>> connected_faces(const AtlasSurface& surface) {
    std::vector<std::vector<std::uint32_t>> result;
    std::vector<bool> is_visited(surface.faces.size(), false);
    std::vector<std::uint32_t> stack;
    for (std::uint32_t first = 0; first < surface.faces.size(); ++first) {
        if (is_visited[first]) continue;
        std::vector<std::uint32_t>& faces = result.emplace_back();
        is_visited[first] = true;
        stack.push_back(first);
        while (!stack.empty()) {
            const std::uint32_t face = stack.back();
            stack.pop_back();
            faces.push_back(face);
            for (Corner corner = 3 * face; corner < 3 * face + 3; ++corner) {
                const Corner other = surface.opposite[corner];
                if (other == no_corner || is_visited[other / 3]) continue;
                is_visited[other / 3] = true;
                stack.push_back(other / 3);
            }
        }
        std::sort(faces.begin(), faces.end());
    }
    return result;
}

std::vector<FlatChart> existing_charts(const AtlasSurface& surface, const Mesh& mesh,
                                       const glm::ivec2& size, bool unmirror, Report& report) {
    if (mesh.texcoords.empty()) throw InvalidInput("there are no texture coordinates to repack");
    const std::vector<glm::dvec2> points = corner_points(surface, mesh, size);
    std::vector<std::vector<std::uint32_t>> all_faces = connected_faces(surface);
    std::vector<std::uint32_t> chart_of(surface.faces.size());
    for (std::uint32_t i = 0; i < all_faces.size(); ++i)
        for (const std::uint32_t face : all_faces[i])
            chart_of[face] = i;
    ChartMembers members(std::move(chart_of));
    std::vector<FlatChart> charts;
    double map_area = 0.0;
    for (std::vector<std::uint32_t>& faces : all_faces) {
        check_cancelled(charts.size());
        members.assign(faces);
        FlatChart chart;
        chart.mesh = chart_mesh(surface, members, std::move(faces));
        chart.coordinates.resize(chart.mesh.positions.size());
        for (std::size_t i = 0; i < chart.mesh.faces.size(); ++i) {
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t vertex = chart.mesh.vertices[i][static_cast<glm::length_t>(k)];
                chart.coordinates[vertex] = points[3 * std::size_t{chart.mesh.faces[i]} + k];
            }
            chart.area += surface.areas[chart.mesh.faces[i]];
        }
        const double area = signed_area(chart);
        map_area += std::abs(area);
        if (area < 0.0) {
            report.add("mirrored chart", "chart", charts.size(),
                       unmirror ? "is reflected" : "stays mirrored");
            if (unmirror)
                for (glm::dvec2& each : chart.coordinates)
                    each.x = -each.x;
        }
        shift_to_origin(chart);
        charts.push_back(std::move(chart));
    }
    if (!(map_area > 0.0)) throw InvalidInput("the texture coordinates have no area");
    const double total = std::accumulate(surface.areas.begin(), surface.areas.end(), 0.0);
    const double scale = std::sqrt(total / map_area);
    for (FlatChart& chart : charts) {
        chart.size *= scale;
        for (glm::dvec2& each : chart.coordinates)
            each *= scale;
    }
    return charts;
}

}  // namespace relief::detail
