// SPDX-License-Identifier: Apache-2.0
#include "atlas/separation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

#include "atlas/chart_outline.h"
#include "atlas/overlap_map.h"
#include "progress_stage.h"

namespace relief::detail {
namespace {

/// The number of operations for each pair of charts and in all, and the largest share of them at
/// one scale.
constexpr std::uint64_t work_of_pair = 320'000;
constexpr std::uint64_t max_work = 48'000'000;
constexpr std::uint64_t work_share = 5;
/// The rise of the scale. It is halved after a failure; after the least one, it is the first again,
/// with other cuts.
constexpr double first_step = 0.01;
constexpr double min_step = 0.0025;
/// A scale is given up after so many passes without progress.
constexpr int max_idle_passes = 20;
/// The number of cuts along which charts are pushed together, of which the best is taken.
constexpr int cut_count = 8;
/// A chart tries so many random rows, and descends from there if the cost is at most this multiple
/// of that near its place.
constexpr int random_rows = 8;
constexpr std::int64_t promising = 4;
/// Rows of a mask that estimate the cost in random rows: one of so many.
constexpr int row_stride = 4;
/// The first step of a descent, in rows, and the reach of rows to the sides, in cells.
constexpr int descent_step = 16;
constexpr int near_reach = 32;
constexpr int descent_reach = 8;
constexpr std::int32_t first_weight = 16;
constexpr std::int64_t max_weight = 1 << 20;

constexpr std::size_t rotation_count = 8;

/// The rotations by multiples of 45 degrees.
std::array<glm::dvec2, rotation_count> rotations() {
    const double diagonal = std::sqrt(0.5);
    std::array<glm::dvec2, rotation_count> result;
    for (std::size_t i = 0; i < rotation_count; i += 2) {
        result[i] = i == 0 ? glm::dvec2(1.0, 0.0) : rotated(result[i - 2], {0.0, 1.0});
        result[i + 1] = i == 0 ? glm::dvec2(diagonal) : rotated(result[i - 1], {0.0, 1.0});
    }
    return result;
}

/// A chart in one rotation at the present scale.
struct RotatedChart {
    glm::dvec2 offset{0.0};  ///< Of the chart's origin from the corner of the mask, texels.
    CellMask mask;
};

struct Place {
    std::size_t rotation = 0;
    OverlapMap::Position at{0, 0};
};

/// A place and the weighted number of shared cells there.
struct Candidate {
    Place place;
    std::int64_t cost = std::numeric_limits<std::int64_t>::max();
};

struct Overlap {
    std::size_t chart, other;
    std::int64_t cells;
};

class Separation {
  public:
    Separation(std::span<const FlatChart> charts, const SeparationOptions& options,
               const Packing& packing)
        : charts_(charts),
          options_(options),
          rotations_(rotations()),
          outlines_(charts.size()),
          poses_(charts.size()),
          places_(charts.size()),
          map_(options.packing.size.x / options.cell, options.packing.size.y / options.cell),
          weights_(charts.size() * charts.size(), first_weight),
          kept_scale_(packing.texels_per_unit),
          max_work_(std::min(work_of_pair * charts.size() * charts.size(), max_work)) {
        set_scale(packing.texels_per_unit);
        for (std::size_t i = 0; i < charts.size(); ++i) {
            const Placement& placement = packing.placements[i];
            const auto rotation =
                std::find(rotations_.begin(), rotations_.end(), placement.direction);
            places_[i].rotation =
                static_cast<std::size_t>(rotation - rotations_.begin()) % rotation_count;
            const RotatedChart& pose = this->pose(i, places_[i].rotation);
            centers_.push_back(placement.offset - pose.offset + 0.5 * size_of(pose));
        }
        kept_ = places_;
    }

    [[nodiscard]] bool has_time() const { return map_.work() < max_work_; }

    /// Tries to place all charts at a scale, beginning with the last places that were kept.
    bool separate_at(double scale) {
        const double growth = scale / kept_scale_;
        set_scale(scale);
        spread(growth);
        return separate();
    }

    /// Keeps the places after a success.
    Packing keep() {
        Packing packing{scale_, {}};
        kept_ = places_;
        for (std::size_t i = 0; i < charts_.size(); ++i) {
            const Place& place = places_[i];
            const RotatedChart& pose = this->pose(i, place.rotation);
            // Blocks of texels are counted from the upper edge of the map.
            const glm::dvec2 corner(
                place.at.x * options_.cell,
                place.at.y * options_.cell + options_.packing.size.y % options_.cell);
            packing.placements.push_back({rotations_[place.rotation], corner + pose.offset});
            centers_[i] = corner + 0.5 * size_of(pose);
        }
        kept_scale_ = scale_;
        return packing;
    }

  private:
    void set_scale(double scale) {
        scale_ = scale;
        for (auto& each : poses_)
            each.fill(std::nullopt);
    }

    /// Returns a pose, which is computed when it is first needed.
    const RotatedChart& pose(std::size_t chart, std::size_t rotation) {
        std::optional<RotatedChart>& pose = poses_[chart][rotation];
        if (pose) return *pose;
        std::optional<Outline>& outline = outlines_[chart][rotation];
        if (!outline) outline = outline_of(charts_[chart], rotations_[rotation]);
        pose.emplace();
        pose->offset = glm::dvec2(options_.margin.side) - outline->low * scale_;
        pose->mask = mask_of(*outline, scale_, options_.margin, options_.cell);
        return *pose;
    }
    [[nodiscard]] glm::dvec2 size_of(const RotatedChart& pose) const {
        return static_cast<double>(options_.cell) * glm::dvec2(pose.mask.width, pose.mask.height);
    }
    [[nodiscard]] bool fits(const CellMask& mask) const {
        return mask.width <= map_.width() && mask.height <= map_.height();
    }

    /// Scales the places with the charts. Those beyond a vertical or horizontal cut are pushed back
    /// into the map, so that only charts at the cuts overlap much.
    void spread(double growth) {
        const glm::dvec2 size(options_.packing.size);
        std::vector<glm::dvec2> best;
        std::int64_t least = std::numeric_limits<std::int64_t>::max();
        for (int i = 0; i < cut_count; ++i) {
            const glm::dvec2 cut = size * glm::dvec2(random_share(), random_share());
            std::vector<glm::dvec2> centers;
            for (const glm::dvec2& each : centers_) {
                const glm::dvec2 shift(each.x > cut.x ? size.x : 0.0,
                                       each.y > cut.y ? size.y : 0.0);
                centers.push_back(growth * each - (growth - 1.0) * shift);
            }
            place_at(centers);
            std::int64_t cells = 0;
            for (const Overlap& each : overlaps())
                cells += each.cells;
            if (cells >= least) continue;
            least = cells;
            best = std::move(centers);
        }
        place_at(best);
    }

    void place_at(std::span<const glm::dvec2> centers) {
        const auto begin = [&](double center, int length, int total) {
            const double corner = std::floor(center / options_.cell - 0.5 * length + 0.5);
            return static_cast<int>(std::clamp<double>(corner, 0.0, std::max(total - length, 0)));
        };
        map_.clear();
        for (std::size_t i = 0; i < charts_.size(); ++i) {
            places_[i].rotation = fitting_rotation(i, kept_[i].rotation);
            const CellMask& mask = pose(i, places_[i].rotation).mask;
            places_[i].at = {begin(centers[i].x, mask.width, map_.width()),
                             begin(centers[i].y, mask.height, map_.height())};
            map_.insert(static_cast<std::uint32_t>(i), mask, places_[i].at);
        }
    }
    /// Returns a rotation in which the chart is inside of the map, the given one if possible.
    std::size_t fitting_rotation(std::size_t chart, std::size_t rotation) {
        for (std::size_t i = 0; i < rotation_count; ++i)
            if (const std::size_t each = (rotation + i) % rotation_count;
                fits(pose(chart, each).mask))
                return each;
        return rotation;
    }

    /// Returns the overlaps of all pairs, each twice.
    std::vector<Overlap> overlaps() {
        std::vector<Overlap> result;
        std::vector<std::int64_t> cells(charts_.size());
        for (std::size_t i = 0; i < charts_.size(); ++i) {
            std::fill(cells.begin(), cells.end(), 0);
            map_.add_overlaps(pose(i, places_[i].rotation).mask, places_[i].at, cells);
            for (std::size_t j = 0; j < cells.size(); ++j)
                if (i != j && cells[j] > 0) result.push_back({i, j, cells[j]});
        }
        return result;
    }

    /// Moves charts until none overlap. \return false if that fails
    bool separate() {
        std::fill(weights_.begin(), weights_.end(), first_weight);
        const std::uint64_t end = std::min(map_.work() + max_work_ / work_share, max_work_);
        std::int64_t least = std::numeric_limits<std::int64_t>::max();
        for (int idle = 0; idle <= max_idle_passes && map_.work() < end; ++idle) {
            check_cancelled();
            const std::vector<Overlap> overlaps = this->overlaps();
            if (overlaps.empty()) return true;
            std::int64_t cells = 0;
            std::vector<std::size_t> moved;
            for (const Overlap& each : overlaps) {
                cells += each.cells;
                if (moved.empty() || moved.back() != each.chart) moved.push_back(each.chart);
            }
            if (cells < least) {
                least = cells;
                idle = 0;
            }
            raise_weights(overlaps);
            for (std::size_t i = moved.size(); i > 1; --i)
                std::swap(moved[i - 1], moved[random(i)]);
            for (const std::size_t chart : moved)
                move(chart);
        }
        return overlaps().empty();
    }

    /// Doubles the weight of the largest overlap, and raises the others by a quarter or more.
    void raise_weights(std::span<const Overlap> overlaps) {
        std::int64_t largest = 0;
        for (const Overlap& each : overlaps)
            largest = std::max(largest, each.cells);
        for (const Overlap& each : overlaps) {
            std::int32_t& weight = weights_[each.chart * charts_.size() + each.other];
            const std::int64_t rise = weight * (5 + 15 * each.cells / largest) / 20;
            weight = static_cast<std::int32_t>(std::min(weight + rise, max_weight));
        }
    }

    /// Moves a chart to the best place that is found.
    void move(std::size_t chart) {
        const auto index = static_cast<std::uint32_t>(chart);
        const Place& old = places_[chart];
        map_.remove(index, pose(chart, old.rotation).mask, old.at);
        Candidate best;
        try_row(chart, old, near_reach, 1, best);
        descend(chart, best);
        if (best.cost > 0) {
            Candidate other = random_candidate(chart);
            if (other.cost / promising < best.cost) {
                // So far, it is an estimate.
                Candidate exact;
                try_row(chart, other.place, descent_step, 1, exact);
                descend(chart, exact);
                if (exact.cost < best.cost) best = exact;
            }
        }
        places_[chart] = best.place;
        map_.insert(index, pose(chart, best.place.rotation).mask, best.place.at);
    }

    /// Tries the positions of a row that are near a place.
    void try_row(std::size_t chart, const Place& place, int reach, int stride, Candidate& best) {
        const CellMask& mask = pose(chart, place.rotation).mask;
        const OverlapMap::Position& at = place.at;
        if (at.y < 0 || at.y > map_.height() - mask.height || mask.width > map_.width()) return;
        const auto weights =
            std::span<const std::int32_t>(weights_).subspan(chart * charts_.size(), charts_.size());
        const OverlapMap::Best found =
            map_.best_in_row(mask, {at.y, at.x - reach, at.x + reach + 1}, stride, weights, at.x);
        if (found.cost < best.cost) best = {{place.rotation, {found.x, at.y}}, found.cost};
    }

    /// Moves a candidate up or down as long as the cost falls, by smaller and smaller steps.
    void descend(std::size_t chart, Candidate& best) {
        for (int step = descent_step; step > 0 && best.cost > 0;) {
            const Candidate before = best;
            for (const int dy : {step, -step}) {
                Place place = before.place;
                place.at.y += dy;
                try_row(chart, place, 2 * step + descent_reach, 1, best);
            }
            if (best.cost == before.cost) step /= 2;
        }
    }

    /// Returns the best one of some random rows and rotations; its cost is an estimate.
    Candidate random_candidate(std::size_t chart) {
        Candidate best;
        for (int i = 0; i < random_rows; ++i) {
            Place place{random(rotation_count), {0, 0}};
            const CellMask& mask = pose(chart, place.rotation).mask;
            if (!fits(mask)) continue;
            const auto below = [&](int count) {
                return static_cast<int>(random(static_cast<std::size_t>(count)));
            };
            place.at = {below(map_.width() - mask.width + 1),
                        below(map_.height() - mask.height + 1)};
            try_row(chart, place, map_.width(), std::clamp(mask.height / 4, 1, row_stride), best);
        }
        return best;
    }

    /// Returns a number below `count`, the same in each run.
    std::size_t random(std::size_t count) {
        state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
        return static_cast<std::size_t>(state_ >> 33) % count;
    }
    double random_share() { return static_cast<double>(random(1024)) / 1024.0; }

    std::span<const FlatChart> charts_;
    SeparationOptions options_;
    std::array<glm::dvec2, rotation_count> rotations_;
    std::vector<std::array<std::optional<Outline>, rotation_count>> outlines_;
    std::vector<std::array<std::optional<RotatedChart>, rotation_count>> poses_;  ///< At `scale_`.
    std::vector<Place> places_;
    std::vector<Place> kept_;
    std::vector<glm::dvec2> centers_;  ///< Of the charts' boxes at the kept places, texels.
    OverlapMap map_;
    std::vector<std::int32_t> weights_;  ///< Of pairs of charts.
    double scale_ = 0.0;
    double kept_scale_ = 0.0;
    std::uint64_t max_work_;
    std::uint64_t state_ = 1;
};

}  // namespace

void raise_by_separation(std::span<const FlatChart> charts, const SeparationOptions& options,
                         Packing& packing) {
    Separation separation(charts, options, packing);
    double step = first_step;
    while (separation.has_time()) {
        const double scale =
            std::min(packing.texels_per_unit * (1.0 + step), options.largest_scale);
        if (scale <= packing.texels_per_unit) return;
        if (separation.separate_at(scale))
            packing = separation.keep();
        else
            step = step > min_step ? 0.5 * step : first_step;
    }
}

}  // namespace relief::detail
