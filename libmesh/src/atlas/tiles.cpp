// SPDX-License-Identifier: Apache-2.0
#include "atlas/tiles.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

/// The factor by which the density falls if the charts of a tile do not fit at that of another one.
constexpr double density_step = 0.98;
constexpr int max_steps = 50;

/// The charts of each tile, ascending.
std::vector<std::vector<std::size_t>> charts_of_tiles(std::span<const FlatChart> charts,
                                                      int tiles) {
    std::vector<std::size_t> order(charts.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return charts[a].area > charts[b].area; });
    std::vector<double> areas(static_cast<std::size_t>(tiles), 0.0);
    std::vector<std::vector<std::size_t>> result(areas.size());
    for (const std::size_t chart : order) {
        const auto emptiest = std::min_element(areas.begin(), areas.end());
        *emptiest += charts[chart].area;
        result[static_cast<std::size_t>(emptiest - areas.begin())].push_back(chart);
    }
    for (std::vector<std::size_t>& each : result)
        std::sort(each.begin(), each.end());
    std::erase_if(result, [](const std::vector<std::size_t>& each) { return each.empty(); });
    return result;
}

}  // namespace

TiledPacking packed_into_tiles(std::span<const FlatChart> charts, const PackingOptions& options,
                               int tiles) {
    if (tiles == 1) return {packed(charts, options), std::vector<int>(charts.size(), 0)};
    const std::vector<std::vector<std::size_t>> members = charts_of_tiles(charts, tiles);
    std::vector<std::vector<FlatChart>> parts(members.size());
    std::vector<Packing> packings(members.size());
    double least = 0.0;
    for (std::size_t i = 0; i < members.size(); ++i) {
        for (const std::size_t chart : members[i])
            parts[i].push_back(charts[chart]);
        packings[i] = packed(parts[i], options);
        least = i == 0 ? packings[i].texels_per_unit : std::min(least, packings[i].texels_per_unit);
    }
    // All tiles get the density of the fullest one.
    const auto pack_at = [&](double density) {
        PackingOptions fixed = options;
        fixed.texels_per_unit = density;
        try {
            for (std::size_t i = 0; i < parts.size(); ++i)
                if (packings[i].texels_per_unit != density) packings[i] = packed(parts[i], fixed);
        } catch (const InvalidInput&) {
            return false;
        }
        return true;
    };
    for (int step = 0; !pack_at(least); ++step) {
        if (step == max_steps) throw InvalidInput("the charts do not fit into the tiles");
        least *= density_step;
    }
    TiledPacking result{{least, std::vector<Placement>(charts.size())},
                        std::vector<int>(charts.size(), 0)};
    for (std::size_t i = 0; i < members.size(); ++i) {
        for (std::size_t k = 0; k < members[i].size(); ++k) {
            result.packing.placements[members[i][k]] = packings[i].placements[k];
            result.tile[members[i][k]] = static_cast<int>(i);
        }
    }
    return result;
}

}  // namespace relief::detail
