// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>

#include "atlas/charts.h"
#include "atlas/clustering.h"
#include "progress_stage.h"

namespace relief::detail {
namespace {

/// Numbers the connected parts of charts. \return their number
std::size_t number_components(const AtlasSurface& surface, std::vector<std::uint32_t>& chart) {
    std::vector<std::uint32_t> part(chart.size(), no_face);
    std::vector<std::uint32_t> stack;
    std::uint32_t count = 0;
    for (std::uint32_t first = 0; first < chart.size(); ++first) {
        if (part[first] != no_face) continue;
        part[first] = count;
        stack.push_back(first);
        while (!stack.empty()) {
            const std::uint32_t face = stack.back();
            stack.pop_back();
            for (Corner corner = 3 * face; corner < 3 * face + 3; ++corner) {
                const Corner other = surface.opposite[corner];
                if (other == no_corner || surface.is_border[corner]) continue;
                const std::uint32_t neighbor = other / 3;
                if (part[neighbor] != no_face || chart[neighbor] != chart[face]) continue;
                part[neighbor] = count;
                stack.push_back(neighbor);
            }
        }
        ++count;
    }
    chart = std::move(part);
    return count;
}

/// Joins parts below an area with the neighbor that has the longest common border.
void join_small_parts(const AtlasSurface& surface, double min_area, std::size_t count,
                      std::vector<std::uint32_t>& chart) {
    std::vector<double> area(count, 0.0);
    for (std::uint32_t face = 0; face < chart.size(); ++face)
        area[chart[face]] += surface.areas[face];
    std::vector<ClusterEdge> borders;
    for (Corner corner = 0; corner < surface.opposite.size(); ++corner) {
        const Corner other = surface.opposite[corner];
        if (other == no_corner || other < corner || surface.is_border[corner]) continue;
        const auto [a, b] = std::minmax(chart[corner / 3], chart[other / 3]);
        if (a != b && std::min(area[a], area[b]) < min_area)
            borders.push_back({a, b, 1, -1.0F, surface.edge_length(corner)});
    }
    combine_edges(borders, count);
    std::vector<std::uint32_t> target(count);
    std::iota(target.begin(), target.end(), 0U);
    std::vector<double> longest(count, 0.0);
    for (const ClusterEdge& border : borders) {
        for (const auto& [small, large] :
             {std::pair(border.a, border.b), std::pair(border.b, border.a)}) {
            // Only into parts that stay, so that no chain of parts forms.
            if (area[small] >= min_area || area[large] < min_area) continue;
            if (border.length <= longest[small]) continue;
            longest[small] = border.length;
            target[small] = large;
        }
    }
    for (std::uint32_t& each : chart)
        each = target[each];
}

}  // namespace

void separate_components(const AtlasSurface& surface, Segmentation& segmentation) {
    segmentation.count = number_components(surface, segmentation.chart);
}

void straighten_borders(const AtlasSurface& surface, Segmentation& segmentation) {
    std::size_t count = number_components(surface, segmentation.chart);
    const double total = std::accumulate(surface.areas.begin(), surface.areas.end(), 0.0);
    join_small_parts(surface, min_part_area * total, count, segmentation.chart);
    segmentation.count = number_components(surface, segmentation.chart);
    replace_borders(surface, segmentation, std::vector<std::uint32_t>(segmentation.count, 0));
    segmentation.count = number_components(surface, segmentation.chart);
}

}  // namespace relief::detail
