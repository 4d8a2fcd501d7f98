// SPDX-License-Identifier: Apache-2.0
#include "atlas/atlas_stats.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "atlas/flat_charts.h"
#include "atlas/flatten.h"

namespace relief::detail {
namespace {

constexpr double small_chart_texels = 64.0;

/// The value below which a share of the weights lies. \param values with weights, ascending
double quantile(std::span<const std::pair<double, double>> values, double share) {
    double sum = 0.0;
    double total = 0.0;
    for (const auto& [value, weight] : values)
        total += weight;
    for (const auto& [value, weight] : values) {
        sum += weight;
        if (sum >= share * total) return value;
    }
    return values.empty() ? 0.0 : values.back().first;
}

/// The edges between two charts, and between a chart and a face without one, on the side of charts.
std::vector<Corner> border_edges(const AtlasSurface& surface, const FaceCharts& charts) {
    std::vector<Corner> edges;
    for (Corner edge = 0; edge < surface.opposite.size(); ++edge) {
        const std::uint32_t chart = charts.chart[edge / 3];
        const Corner other = surface.opposite[edge];
        if (chart != no_face && (other == no_corner || charts.chart[other / 3] != chart))
            edges.push_back(edge);
    }
    return edges;
}

/// The length of the borders of charts. Where several faces meet, each pair of opposite directions
/// counts once.
double seam_length(const AtlasSurface& surface, std::span<const Corner> borders) {
    struct BorderEdge {
        std::uint32_t low, high;
        bool is_forward;
        Corner corner;
    };
    std::vector<BorderEdge> edges;
    edges.reserve(borders.size());
    for (const Corner edge : borders) {
        const glm::uvec3& face = surface.faces[edge / 3];
        const std::uint32_t from = face[static_cast<glm::length_t>(edge % 3)];
        const std::uint32_t to = face[static_cast<glm::length_t>((edge + 1) % 3)];
        edges.push_back({std::min(from, to), std::max(from, to), from < to, edge});
    }
    std::sort(edges.begin(), edges.end(), [](const BorderEdge& a, const BorderEdge& b) {
        if (a.low != b.low) return a.low < b.low;
        return a.high != b.high ? a.high < b.high : a.corner < b.corner;
    });
    double length = 0.0;
    for (auto first = edges.begin(); first != edges.end();) {
        const auto last = std::find_if(first, edges.end(), [&](const BorderEdge& edge) {
            return edge.low != first->low || edge.high != first->high;
        });
        const auto forward = std::count_if(first, last, [](auto& edge) { return edge.is_forward; });
        const auto count = std::max(forward, last - first - forward);
        length += static_cast<double>(count) * surface.edge_length(first->corner);
        first = last;
    }
    return length;
}

}  // namespace

std::vector<std::uint32_t> triangles_of_faces(const AtlasSurface& surface) {
    std::vector<std::uint32_t> triangles(surface.faces.size());
    for (std::size_t t = surface.face_of_triangle.size(); t-- > 0;) {
        const std::uint32_t face = surface.face_of_triangle[t];
        if (face != no_face) triangles[face] = static_cast<std::uint32_t>(t);
    }
    return triangles;
}

std::array<glm::dvec2, 3> texels_of(std::span<const glm::vec2> corner_texcoords,
                                    const AtlasSurface& surface, std::uint32_t triangle,
                                    const glm::ivec2& size) {
    std::array<glm::dvec2, 3> texels;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t corner = (i + surface.first_corner[triangle]) % 3;
        const glm::dvec2 uv(corner_texcoords[3 * std::size_t{triangle} + corner]);
        texels[i] = glm::dvec2(uv.x, 1.0 - uv.y) * glm::dvec2(size);
    }
    return texels;
}

std::optional<int> safe_mip_level(double distance) {
    constexpr double rounding = 1e-3;
    if (!(distance + rounding >= 3.0)) return std::nullopt;
    int level = 0;
    while (3.0 * static_cast<double>(std::uint64_t{2} << level) <= distance + rounding)
        ++level;
    return level;
}

AtlasStats stats_of(const AtlasSurface& surface, std::span<const glm::vec2> corner_texcoords,
                    const FaceCharts& charts, const glm::ivec2& size) {
    AtlasStats stats;
    stats.charts = charts.count;
    const std::vector<std::uint32_t> triangles = triangles_of_faces(surface);
    double area = 0.0;
    std::size_t measured = 0;
    for (std::uint32_t face = 0; face < surface.faces.size(); ++face) {
        if (charts.chart[face] == no_face) continue;
        area += surface.areas[face];
        ++measured;
    }
    const double min_area = min_area_share(surface.faces.size()) * area;
    std::vector<std::pair<double, double>> densities;
    densities.reserve(measured);
    std::vector<double> chart_texels(charts.count, 0.0);
    for (std::uint32_t face = 0; face < surface.faces.size(); ++face) {
        if (charts.chart[face] == no_face) continue;
        const Stretch stretch =
            stretch_of(surface, face, texels_of(corner_texcoords, surface, triangles[face], size));
        const double smallest = std::abs(stretch.smallest);
        const double weight = surface.areas[face];
        chart_texels[charts.chart[face]] += weight * stretch.largest * smallest;
        densities.emplace_back(std::sqrt(stretch.largest * smallest), weight);
        stats.stretch += 0.5 * weight *
                         (1.0 / (stretch.largest * stretch.largest) + 1.0 / (smallest * smallest));
        const double anisotropy = stretch.largest / smallest;
        stats.mean_anisotropy += weight * anisotropy;
        if (weight >= min_area) stats.max_anisotropy = std::max(stats.max_anisotropy, anisotropy);
    }
    if (!(area > 0.0)) return stats;
    double map_area = 0.0;
    for (const double texels : chart_texels) {
        map_area += texels;
        if (texels < small_chart_texels) ++stats.small_charts;
    }
    const double mean_density = std::sqrt(map_area / area);
    std::sort(densities.begin(), densities.end());
    stats.min_density = quantile(densities, 0.05) / mean_density;
    stats.max_density = quantile(densities, 0.95) / mean_density;
    stats.stretch = std::sqrt(stats.stretch / area) * mean_density;
    stats.mean_anisotropy /= area;
    stats.used = map_area / (static_cast<double>(size.x) * size.y);
    stats.texels_per_unit = mean_density / surface.unit;
    stats.area = area * surface.unit * surface.unit;
    const std::vector<Corner> borders = border_edges(surface, charts);
    for (const Corner edge : borders) {
        const auto corners = texels_of(corner_texcoords, surface, triangles[edge / 3], size);
        stats.perimeter += glm::length(corners[(edge + 1) % 3] - corners[edge % 3]);
    }
    const double seams = seam_length(surface, borders);
    stats.relative_seam_length = seams / std::sqrt(area);
    stats.seam_length = seams * surface.unit;
    return stats;
}

}  // namespace relief::detail
