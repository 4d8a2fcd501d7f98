// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "atlas/charts.h"
#include "atlas/clustering.h"
#include "progress_stage.h"

namespace relief::detail {
namespace {

/// The shares of the charts in a face near a border.
struct Shares {
    static constexpr std::size_t max_charts = 4;
    std::array<std::uint32_t, max_charts> chart{};
    std::array<float, max_charts> share{};
    std::uint8_t count = 0;

    void add(std::uint32_t which, float amount) {
        for (std::size_t i = 0; i < count; ++i) {
            if (chart[i] != which) continue;
            share[i] += amount;
            return;
        }
        if (count == max_charts) return;  // A fifth chart has a small share.
        chart[count] = which;
        share[count++] = amount;
    }
    /// Returns the chart with the largest share; the smaller number wins a tie.
    [[nodiscard]] std::uint32_t largest() const {
        std::size_t best = 0;
        for (std::size_t i = 1; i < count; ++i) {
            if (share[i] > share[best] || (share[i] == share[best] && chart[i] < chart[best]))
                best = i;
        }
        return chart[best];
    }
};

/// The faces within some steps of a border between charts, ascending.
std::vector<std::uint32_t> band_of(const AtlasSurface& surface,
                                   std::span<const std::uint32_t> chart, int steps) {
    std::vector<std::uint8_t> is_near(chart.size(), 0);
    std::vector<std::uint32_t> front;
    std::vector<std::uint32_t> next;
    for (Corner corner = 0; corner < surface.opposite.size(); ++corner) {
        const Corner other = surface.opposite[corner];
        if (other == no_corner || surface.is_border[corner]) continue;
        const std::uint32_t face = corner / 3;
        if (chart[face] == chart[other / 3] || is_near[face] != 0) continue;
        is_near[face] = 1;
        front.push_back(face);
    }
    for (int step = 1; step < steps && !front.empty(); ++step) {
        next.clear();
        for (const std::uint32_t face : front) {
            for (Corner corner = 3 * face; corner < 3 * face + 3; ++corner) {
                const Corner other = surface.opposite[corner];
                if (other == no_corner || surface.is_border[corner] || is_near[other / 3] != 0)
                    continue;
                is_near[other / 3] = 1;
                next.push_back(other / 3);
            }
        }
        front.swap(next);
    }
    std::vector<std::uint32_t> band;
    for (std::uint32_t face = 0; face < chart.size(); ++face)
        if (is_near[face] != 0) band.push_back(face);
    return band;
}

/// Gives each face near a border to the chart that has the largest share around it.
void diffuse(const AtlasSurface& surface, int width, int rounds,
             std::vector<std::uint32_t>& chart) {
    constexpr std::uint32_t outside = no_face;
    const std::vector<std::uint32_t> band = band_of(surface, chart, width);
    std::vector<std::uint32_t> place(chart.size(), outside);
    for (std::uint32_t i = 0; i < band.size(); ++i)
        place[band[i]] = i;
    struct Neighbor {
        std::uint32_t place, chart;
        float weight;
    };
    std::vector<std::array<Neighbor, 3>> neighbors(band.size());
    std::vector<Shares> shares(band.size());
    for (std::size_t i = 0; i < band.size(); ++i) {
        shares[i].add(chart[band[i]], 1.0F);
        double sum = 0.0;
        std::array<double, 3> lengths{};
        for (std::uint32_t k = 0; k < 3; ++k) {
            const Corner corner = 3 * band[i] + k;
            const Corner other = surface.opposite[corner];
            const bool is_joined = other != no_corner && !surface.is_border[corner];
            lengths[k] = is_joined ? surface.edge_length(corner) : 0.0;
            sum += lengths[k];
            const std::uint32_t face = is_joined ? other / 3 : band[i];
            neighbors[i][k] = {place[face], chart[face], 0.0F};
        }
        for (std::size_t k = 0; k < 3; ++k)
            neighbors[i][k].weight = sum > 0.0 ? static_cast<float>(0.5 * lengths[k] / sum) : 0.0F;
    }
    std::vector<Shares> next(band.size());
    for (int round = 0; round < rounds; ++round) {
        check_cancelled();
        for (std::size_t i = 0; i < band.size(); ++i) {
            // Inside of one chart nothing changes.
            const Shares& own = shares[i];
            bool is_mixed = own.count > 1;
            for (const Neighbor& each : neighbors[i]) {
                if (each.weight == 0.0F) continue;
                is_mixed = is_mixed || (each.place == outside
                                            ? each.chart != own.chart[0]
                                            : shares[each.place].count > 1 ||
                                                  shares[each.place].chart[0] != own.chart[0]);
            }
            if (!is_mixed) {
                next[i] = own;
                continue;
            }
            Shares mixed;
            float rest = 1.0F;
            for (const Neighbor& each : neighbors[i]) {
                if (each.weight == 0.0F) continue;
                rest -= each.weight;
                if (each.place == outside) {
                    mixed.add(each.chart, each.weight);
                    continue;
                }
                const Shares& theirs = shares[each.place];
                for (std::size_t k = 0; k < theirs.count; ++k)
                    mixed.add(theirs.chart[k], each.weight * theirs.share[k]);
            }
            for (std::size_t k = 0; k < own.count; ++k)
                mixed.add(own.chart[k], rest * own.share[k]);
            next[i] = mixed;
        }
        shares.swap(next);
    }
    for (std::size_t i = 0; i < band.size(); ++i)
        chart[band[i]] = shares[i].largest();
}

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

void smooth_borders(const AtlasSurface& surface, Segmentation& segmentation) {
    const double size = segmentation.cluster_size;
    // Borders are jagged by the diameter of a small cluster.
    const int width = static_cast<int>(2.0 * std::sqrt(size)) + 2;
    const int rounds = static_cast<int>(1.5 * size) + 4;
    diffuse(surface, width, rounds, segmentation.chart);
    const std::size_t count = number_components(surface, segmentation.chart);
    const double total = std::accumulate(surface.areas.begin(), surface.areas.end(), 0.0);
    join_small_parts(surface, min_part_area * total, count, segmentation.chart);
    segmentation.count = number_components(surface, segmentation.chart);
}

}  // namespace relief::detail
