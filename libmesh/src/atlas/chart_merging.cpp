// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "atlas/flat_charts.h"
#include "parallel.h"
#include "progress_stage.h"

namespace relief::detail {
namespace {

/// Charts below this share of the area look for any neighbor; larger ones for one behind a smooth
/// border.
constexpr double max_area_share = 0.02;
/// The cosine of the angle between the faces of a crease.
constexpr double crease_cosine = 0.4;
/// The share of creases in a common border above which it is not smooth.
constexpr double max_crease_share = 0.2;
/// The share of the common border in the shorter perimeter below which charts do not merge.
constexpr double min_border_share = 0.15;
/// The box of a union may be larger than both boxes by this factor: long and branched charts waste
/// space in the map.
constexpr double max_box_growth = 1.25;
/// The largest energy_of() of a union: of small charts, which matter little, and of others. It
/// keeps the L2 stretch below 1.005.
constexpr double max_union_energy = 1.02;
constexpr double max_large_union_energy = 1.006;
/// Noise stretches charts, however small they are. So small unions may have the energy that their
/// charts have before anything is merged, up to this one, and a little more: unions of noisy charts
/// are almost never stretched less than their charts.
constexpr double max_noise_energy = 1.05;
constexpr double noise_rise = 0.05;
/// Dust: charts below this number of texels, if all of them have a small share of the area. The
/// energy of a union may grow as if this much more were spent on the dust alone.
constexpr double dust_texels = 128.0;
constexpr double max_dust_share = 0.01;
constexpr double dust_energy = 1.0;
/// The number of failures after which a chart stays as it is, and after which dust does.
constexpr int max_failures = 3;
constexpr int max_dust_failures = 6;
/// The number of faces of all unions that are tried, per face of the surface: with small charts,
/// with dust, and with larger charts. Small and larger charts may also try a fixed number of faces,
/// which costs little time.
constexpr double max_tried_faces = 2.0;
constexpr double max_tried_besides = 250000.0;
constexpr double max_tried_with_dust = 1.0;
constexpr double max_tried_large = 0.05;
constexpr double max_tried_at_all = 20000.0;
constexpr int max_rounds = 64;

double box_area(const FlatChart& chart) {
    return chart.size.x * chart.size.y;
}

/// Works in rounds: each chart is in one pair at most, and the unions of all pairs are flattened in
/// parallel.
class ChartMerger {
  public:
    ChartMerger(const AtlasSurface& surface, ChartMembers& members, const FlatnessLimits& limits,
                std::vector<FlatChart> charts)
        : surface_(surface),
          members_(members),
          limits_(limits),
          charts_(std::move(charts)),
          chart_of_(surface.faces.size()),
          perimeters_(charts_.size()),
          energies_(charts_.size()),
          failures_(charts_.size(), 0),
          faces_left_(max_tried_faces * static_cast<double>(surface.faces.size()) +
                      std::min(max_tried_besides, static_cast<double>(surface.faces.size()))),
          dust_faces_left_(max_tried_with_dust * static_cast<double>(surface.faces.size())),
          large_faces_left_(max_tried_at_all +
                            max_tried_large * static_cast<double>(surface.faces.size())) {
        for (std::uint32_t chart = 0; chart < charts_.size(); ++chart) {
            total_area_ += charts_[chart].area;
            adopt(chart);
        }
        parallel_for(charts_.size(), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                energies_[i] = std::min(energy_of(surface_, charts_[i]), max_noise_energy);
        });
        max_dust_area_ = dust_texels * limits.texel * limits.texel;
        double dust_area = 0.0;
        for (const FlatChart& chart : charts_)
            if (chart.area < max_dust_area_) dust_area += chart.area;
        if (dust_area > max_dust_share * total_area_) max_dust_area_ = 0.0;
        for (Corner corner = 0; corner < surface.opposite.size(); ++corner) {
            const Corner other = surface.opposite[corner];
            if (other == no_corner || other < corner || surface.is_border[corner]) continue;
            if (chart_of_[corner / 3] != chart_of_[other / 3]) seams_.push_back(corner);
        }
    }

    std::vector<FlatChart> merged() {
        for (int round = 0; round < max_rounds; ++round) {
            check_cancelled();
            const std::vector<Pair> pairs = selected(candidates());
            if (pairs.empty()) break;
            merge(pairs);
        }
        std::erase_if(charts_, [](const FlatChart& chart) { return chart.mesh.faces.empty(); });
        return std::move(charts_);
    }

  private:
    /// Two neighbors, a < b.
    struct Pair {
        std::uint32_t a, b;
        double length;       ///< Of the common border.
        double creases;      ///< Their length in the common border.
        double share = 0.0;  ///< Of the common border in the shorter perimeter.
    };

    /// Renews what is known of a chart.
    void adopt(std::uint32_t chart) {
        const ChartMesh& mesh = charts_[chart].mesh;
        for (const std::uint32_t face : mesh.faces)
            chart_of_[face] = chart;
        perimeters_[chart] = 0.0;
        for (Corner corner = 0; corner < mesh.opposite.size(); ++corner)
            if (mesh.opposite[corner] == no_corner)
                perimeters_[chart] += surface_.edge_length(3 * mesh.faces[corner / 3] + corner % 3);
    }

    [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> charts_at(Corner seam) const {
        return std::minmax({chart_of_[seam / 3], chart_of_[surface_.opposite[seam] / 3]});
    }

    /// Returns the pairs that may merge, those with the largest share first.
    std::vector<Pair> candidates() {
        std::erase_if(seams_, [&](Corner seam) {
            const auto [a, b] = charts_at(seam);
            return a == b;
        });
        std::vector<Pair> borders;
        borders.reserve(seams_.size());
        for (const Corner seam : seams_) {
            const auto [a, b] = charts_at(seam);
            const double length = surface_.edge_length(seam);
            const double cosine =
                glm::dot(surface_.normal(seam / 3), surface_.normal(surface_.opposite[seam] / 3));
            borders.push_back({a, b, length, cosine < crease_cosine ? length : 0.0});
        }
        // Stable, so that lengths are added in a fixed order.
        std::stable_sort(borders.begin(), borders.end(), [](const Pair& x, const Pair& y) {
            return x.a != y.a ? x.a < y.a : x.b < y.b;
        });
        std::vector<Pair> pairs;
        for (const Pair& border : borders) {
            if (pairs.empty() || pairs.back().a != border.a || pairs.back().b != border.b) {
                pairs.push_back(border);
                continue;
            }
            pairs.back().length += border.length;
            pairs.back().creases += border.creases;
        }
        std::erase_if(pairs, [&](Pair& pair) {
            pair.share = pair.length / std::min(perimeters_[pair.a], perimeters_[pair.b]);
            const std::uint32_t small = smaller(pair);
            // A closed union cannot be flattened.
            const double longer = std::max(perimeters_[pair.a], perimeters_[pair.b]);
            return pair.length > (1.0 - 1e-9) * longer || pair.share < min_border_share ||
                   failures_[small] >= (is_dust(pair) ? max_dust_failures : max_failures) ||
                   (is_large(pair) && pair.creases > max_crease_share * pair.length) ||
                   std::binary_search(failed_.begin(), failed_.end(), std::pair(pair.a, pair.b));
        });
        std::stable_sort(pairs.begin(), pairs.end(),
                         [](const Pair& x, const Pair& y) { return x.share > y.share; });
        return pairs;
    }
    [[nodiscard]] bool is_large(const Pair& pair) const {
        return charts_[smaller(pair)].area > max_area_share * total_area_;
    }
    [[nodiscard]] bool is_dust(const Pair& pair) const {
        return charts_[smaller(pair)].area < max_dust_area_;
    }
    /// Returns the largest permitted energy of the union of a pair.
    [[nodiscard]] double max_energy(const Pair& pair) const {
        if (is_large(pair)) return max_large_union_energy;
        const double area = charts_[pair.a].area + charts_[pair.b].area;
        double energy = mean_energy(pair);
        energy += noise_rise * (energy - 1.0);
        if (is_dust(pair)) energy += dust_energy * charts_[smaller(pair)].area / area;
        return std::max(max_union_energy, energy);
    }
    /// Dust, whose energy hardly counts, must not bring a triangle near the stretch limit that was
    /// far from it.
    [[nodiscard]] FlatnessLimits limits_of(const Pair& pair) const {
        FlatnessLimits limits = limits_;
        if (!is_dust(pair)) return limits;
        const double largest = std::max(largest_stretch(surface_, charts_[pair.a], total_area_),
                                        largest_stretch(surface_, charts_[pair.b], total_area_));
        limits.max_stretch =
            std::min(limits.max_stretch, std::max(largest, std::sqrt(limits.max_stretch)));
        return limits;
    }
    /// Returns the energy of a pair before anything was merged.
    [[nodiscard]] double mean_energy(const Pair& pair) const {
        const double a = charts_[pair.a].area;
        const double b = charts_[pair.b].area;
        return (energies_[pair.a] * a + energies_[pair.b] * b) / (a + b);
    }
    [[nodiscard]] std::uint32_t smaller(const Pair& pair) const {
        return charts_[pair.a].area < charts_[pair.b].area ? pair.a : pair.b;
    }

    /// Returns pairs without a common chart.
    std::vector<Pair> selected(const std::vector<Pair>& candidates) {
        std::vector<bool> is_used(charts_.size(), false);
        std::vector<Pair> result;
        for (const Pair& pair : candidates) {
            const auto faces = static_cast<double>(charts_[pair.a].mesh.faces.size() +
                                                   charts_[pair.b].mesh.faces.size());
            double& left = is_large(pair)  ? large_faces_left_
                           : is_dust(pair) ? dust_faces_left_
                                           : faces_left_;
            if (is_used[pair.a] || is_used[pair.b] || faces > left) continue;
            is_used[pair.a] = is_used[pair.b] = true;
            left -= faces;
            result.push_back(pair);
        }
        return result;
    }

    void merge(const std::vector<Pair>& pairs) {
        std::vector<std::vector<std::uint32_t>> faces(pairs.size());
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const std::vector<std::uint32_t>& a = charts_[pairs[i].a].mesh.faces;
            const std::vector<std::uint32_t>& b = charts_[pairs[i].b].mesh.faces;
            std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(faces[i]));
            members_.join(faces[i]);
        }
        std::vector<std::optional<FlatChart>> unions(pairs.size());
        parallel_for(pairs.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                check_cancelled();
                unions[i] = flattened_union(surface_, members_, std::move(faces[i]),
                                            limits_of(pairs[i]), total_area_, max_energy(pairs[i]));
            }
        });
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            FlatChart& a = charts_[pairs[i].a];
            FlatChart& b = charts_[pairs[i].b];
            if (!unions[i] || box_area(*unions[i]) > max_box_growth * (box_area(a) + box_area(b))) {
                ++failures_[smaller(pairs[i])];
                failed_.emplace_back(pairs[i].a, pairs[i].b);
                continue;
            }
            energies_[pairs[i].a] = mean_energy(pairs[i]);
            a = std::move(*unions[i]);
            b = FlatChart();
            adopt(pairs[i].a);
        }
        std::sort(failed_.begin(), failed_.end());
    }

    const AtlasSurface& surface_;
    ChartMembers& members_;
    const FlatnessLimits& limits_;
    std::vector<FlatChart> charts_;        ///< Without faces if it is part of another one.
    std::vector<std::uint32_t> chart_of_;  ///< For each face.
    std::vector<double> perimeters_;       ///< Of the charts.
    std::vector<double> energies_;         ///< Of the charts before anything was merged.
    std::vector<int> failures_;            ///< Of a chart as the smaller one of a pair.
    std::vector<Corner> seams_;            ///< One of the two edges between two charts each.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> failed_;  ///< Ascending.
    double total_area_ = 0.0;
    double max_dust_area_ = 0.0;
    double faces_left_;        ///< The number of faces of unions that may still be tried.
    double dust_faces_left_;   ///< The same with dust.
    double large_faces_left_;  ///< The same with charts that are not small.
};

}  // namespace

std::vector<FlatChart> merged_charts(const AtlasSurface& surface, ChartMembers& members,
                                     const FlatnessLimits& limits, std::vector<FlatChart> charts) {
    return ChartMerger(surface, members, limits, std::move(charts)).merged();
}

}  // namespace relief::detail
