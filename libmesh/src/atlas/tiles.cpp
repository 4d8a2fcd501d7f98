// SPDX-License-Identifier: Apache-2.0
#include "atlas/tiles.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

/// Many charts per tile are balanced by their areas; up to this number, some change their tile.
constexpr std::size_t max_balanced = 16;
/// The factor by which the density falls if the charts of a tile do not fit at that of another one.
constexpr double density_step = 0.99;
constexpr int max_steps = 100;

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
    std::vector<std::vector<std::size_t>> members = charts_of_tiles(charts, tiles);
    const auto charts_in = [&](const std::vector<std::size_t>& tile) {
        std::vector<FlatChart> result;
        for (const std::size_t chart : tile)
            result.push_back(charts[chart]);
        return result;
    };
    std::vector<Packing> packings(members.size());
    for (std::size_t i = 0; i < members.size(); ++i)
        packings[i] = packed(charts_in(members[i]), options);
    const auto is_denser = [](const Packing& a, const Packing& b) {
        return a.texels_per_unit < b.texels_per_unit;
    };
    // The smallest chart of the fullest tile moves to the emptiest one, as long as that helps.
    const bool may_move =
        !options.texels_per_unit && charts.size() <= max_balanced * static_cast<std::size_t>(tiles);
    for (int move = 0; move < tiles && may_move; ++move) {
        const auto [fullest, emptiest] =
            std::minmax_element(packings.begin(), packings.end(), is_denser);
        const auto from = static_cast<std::size_t>(fullest - packings.begin());
        const auto to = static_cast<std::size_t>(emptiest - packings.begin());
        if (from == to || members[from].size() < 2) break;
        std::vector<std::size_t> source = members[from];
        std::vector<std::size_t> target = members[to];
        const auto smallest = std::min_element(
            source.begin(), source.end(),
            [&](std::size_t a, std::size_t b) { return charts[a].area < charts[b].area; });
        target.insert(std::upper_bound(target.begin(), target.end(), *smallest), *smallest);
        source.erase(smallest);
        Packing more = packed(charts_in(target), options);
        if (more.texels_per_unit <= fullest->texels_per_unit) break;
        packings[from] = packed(charts_in(source), options);
        packings[to] = std::move(more);
        members[from] = std::move(source);
        members[to] = std::move(target);
    }
    std::vector<std::vector<FlatChart>> parts(members.size());
    std::transform(members.begin(), members.end(), parts.begin(), charts_in);
    double least = std::min_element(packings.begin(), packings.end(), is_denser)->texels_per_unit;
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
