// SPDX-License-Identifier: Apache-2.0
// Charts are placed one after the other, the large ones first, each at the lowest position in one
// of several rotations: first on large cells, then they slide on small ones. No rule for the order
// and for the best rotation suits all charts. So several rules are tried at one scale, and
// variations of the one that leaves out the least area: charts that were left out come earlier, or
// neighbors in the order change places. The scale rises as long as an attempt succeeds.
#include "atlas/packing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "atlas/atlas_stats.h"
#include "atlas/cell_map.h"
#include "atlas/cell_mask.h"
#include "atlas/chart_outline.h"
#include "atlas/separation.h"
#include "parallel.h"
#include "progress_stage.h"

namespace relief::detail {
namespace {

/// The largest number of cells along the longer side of a map.
constexpr int max_cells = 1024;
/// Positions are searched on cells twice as large.
constexpr int search_level = 1;
/// Charts up to this many search cells begin where the last one of the same size was placed, less
/// some rows. Larger ones try all positions.
constexpr int max_hinted_cells = 16;
constexpr int hint_slack = 8;
/// Up to this many charts also try rotations by 45 degrees.
constexpr std::size_t max_freely_rotated = 64;
/// Above this number of charts, the first attempt should succeed.
constexpr std::size_t max_varied = 1000;
/// More charts than those that are separated, up to this number, are placed on cells of half the
/// size, which the rounding of their borders wastes less of.
constexpr std::size_t max_refined = 1000;
/// From this number of charts on, a quarter of them estimates the scale in a quarter of the map,
/// unless the longest chart exceeds this share of its height, or the quarter has fewer rows of
/// cells.
constexpr std::size_t min_sampled = 5000;
constexpr std::size_t sample_share = 4;
constexpr double max_sampled_length = 0.5;
constexpr int min_sampled_rows = 64;
/// The share of the map that charts and half of their padding cover at first.
constexpr double expected_use = 0.75;
/// The rise of the scale after a success; it is halved if no attempt succeeds, and after the least
/// rise, it is half of the first one again, with other orders.
constexpr double scale_step = 0.01;
constexpr double min_scale_step = 0.002;
/// The number of reductions of the scale after which charts do not fit at all.
constexpr int max_reductions = 60;

/// Half of the padding, and a little for the rounding of coordinates. At corners, it contains a
/// circle, so that charts keep the padding in all directions, and the square of one and a half
/// texels of each mip level for which the padding is enough, which bilinear lookups read.
Margin margin_of(const PackingOptions& options) {
    const double half = 0.5 * options.padding;
    const std::optional<int> level = safe_mip_level(options.padding);
    const double square = level ? 1.5 * static_cast<double>(std::int64_t{1} << *level) : 0.0;
    const double rounding = 1e-3;
    return {half + rounding, std::max(std::sqrt(2.0) * half, 2.0 * square) + 2.0 * rounding};
}

/// Texels of a side of the smallest cells: a multiple of the blocks.
int cell_of(const PackingOptions& options) {
    int cell = options.alignment;
    while (std::max(options.size.x, options.size.y) / cell > max_cells)
        cell *= 2;
    return cell;
}

/// Texels of a side of the smallest cells for placing.
int placing_cell_of(const PackingOptions& options, std::size_t chart_count) {
    const int cell = cell_of(options);
    const bool is_fine = chart_count > max_freely_rotated && chart_count <= max_refined;
    return is_fine && cell % (2 * options.alignment) == 0 ? cell / 2 : cell;
}

/// The number of packs in all, unless none succeeds. Many charts differ little from their mean, so
/// that the estimated scale is exact for them, and each pack takes long. Few charts are separated
/// afterwards, unless the scale is fixed.
std::size_t attempts_for(std::size_t chart_count, bool is_fixed) {
    const std::size_t attempts = std::min(10 * chart_count, 3600 / (chart_count + 40));
    const bool are_separated = chart_count <= max_freely_rotated && !is_fixed;
    return std::clamp<std::size_t>(attempts, 2, are_separated ? 20 : 80);
}

/// A chart in one rotation at one scale.
struct Pose {
    glm::dvec2 direction{1.0, 0.0};
    glm::dvec2 offset{0.0};  ///< Of the chart's origin from the corner of the mask, texels.
    CellMask mask;
    CellMask coarse;            ///< The mask on the cells of the search.
    std::vector<RowRun> lower;  ///< Empty for small masks.
};

/// The order in which charts are placed, and the preference among their rotations.
struct Rule {
    std::vector<std::uint32_t> order;
    /// The cost of a place is its upper edge, plus its lower edge and its left edge with these
    /// weights.
    double lower_weight = 0.0;
    double left_weight = 0.0;
};

/// The charts that did not fit.
struct Outcome {
    std::vector<std::size_t> left_out;  ///< Indices of the order.
    double left_out_area = 0.0;
};

/// Places charts at one scale.
class Packer {
  public:
    /// \param cell  side of the smallest cells, texels
    Packer(std::span<const FlatChart> charts, const PackingOptions& options, int cell)
        : options_(options),
          cell_(cell),
          outlines_(charts.size()),
          poses_(charts.size()),
          places_(charts.size()) {
        areas_.reserve(charts.size());
        for (const FlatChart& each : charts)
            areas_.push_back(each.area);
        const double diagonal = std::sqrt(0.5);
        parallel_for(charts.size(), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                outlines_[i].reserve(charts.size() > max_freely_rotated ? 2 : 4);
                outlines_[i].push_back(outline_of(charts[i], {1.0, 0.0}));
                outlines_[i].push_back(outline_of(charts[i], {0.0, 1.0}));
                if (charts.size() > max_freely_rotated) continue;
                outlines_[i].push_back(outline_of(charts[i], {diagonal, diagonal}));
                outlines_[i].push_back(outline_of(charts[i], {-diagonal, diagonal}));
            }
        });
    }

    /// Prepares charts for pack() at a scale.
    void set_scale(double scale, std::span<const std::uint32_t> charts) {
        if (scale == scale_) return;
        kept_rows_ = 0;
        scale_ = charts.size() == outlines_.size() ? scale : 0.0;
        parallel_for(charts.size(), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                find_poses(charts[i], scale);
        });
    }

    /// Places all charts. Those that do not fit into `rows` rows of cells are left out, until their
    /// area exceeds `limit`.
    Outcome pack(const Rule& rule, int rows, double limit) {
        CellMap map(options_.size.x / cell_, rows, search_level + 1);
        hints_.fill(0);
        height_ = 0;
        Outcome outcome;
        const std::size_t known = known_places(rule, rows);
        for (std::size_t i = 0; i < rule.order.size(); ++i) {
            const std::uint32_t chart = rule.order[i];
            bool is_placed = false;
            if (i < known) {
                places_[chart] = kept_places_[chart];
                is_placed = places_[chart].is_placed;
                if (is_placed) occupy(chart, map);
            } else {
                check_cancelled();
                ++work_;
                is_placed = place(chart, rule, map);
                places_[chart].is_placed = is_placed;
            }
            if (is_placed) continue;
            outcome.left_out.push_back(i);
            outcome.left_out_area += areas_[chart];
            if (outcome.left_out_area > limit) break;
        }
        return outcome;
    }

    /// Keeps the places of a complete pack() for later ones that begin with the same charts.
    void keep(const Rule& rule, int rows) {
        kept_rule_ = rule;
        kept_places_ = places_;
        kept_rows_ = rows;
    }
    /// The number of charts for which places were searched.
    [[nodiscard]] std::size_t work() const { return work_; }

    /// The rows of cells of the map.
    [[nodiscard]] int rows() const { return options_.size.y / cell_; }
    /// The rows of cells that charts use after pack().
    [[nodiscard]] int height() const { return height_; }

    /// Returns the place of a chart after pack().
    [[nodiscard]] Placement placement(std::size_t chart) const {
        const Pose& pose = poses_[chart][places_[chart].pose];
        const CellMap::Position& at = places_[chart].at;
        // Blocks of texels are counted from the upper edge of the map.
        const glm::dvec2 corner(at.x * cell_, at.y * cell_ + options_.size.y % cell_);
        return {pose.direction, corner + pose.offset};
    }

  private:
    struct Place {
        std::size_t pose = 0;
        CellMap::Position at{0, 0};
        bool is_placed = false;
    };

    /// The number of charts at the beginning of an order whose places are kept.
    [[nodiscard]] std::size_t known_places(const Rule& rule, int rows) const {
        if (rows != kept_rows_ || rule.lower_weight != kept_rule_.lower_weight ||
            rule.left_weight != kept_rule_.left_weight ||
            rule.order.size() != kept_rule_.order.size())
            return 0;
        const auto end =
            std::mismatch(rule.order.begin(), rule.order.end(), kept_rule_.order.begin());
        return static_cast<std::size_t>(end.first - rule.order.begin());
    }

    void find_poses(std::size_t chart, double scale) {
        const Margin margin = margin_of(options_);
        std::vector<Pose>& poses = poses_[chart];
        poses.clear();
        poses.reserve(2 * outlines_[chart].size());
        for (const Outline& outline : outlines_[chart]) {
            Pose& pose = poses.emplace_back();
            pose.direction = outline.direction;
            pose.offset = glm::dvec2(margin.side) - outline.low * scale;
            pose.mask = mask_of(outline, scale, margin, cell_);
        }
        for (Pose& pose : poses)
            prepare(pose);
        // Half turns; those of a rectangle change nothing.
        const std::size_t upright = poses.size();
        for (std::size_t i = 0; i < upright; ++i) {
            if (is_full(poses[i].coarse)) continue;
            const CellMask& mask = poses[i].mask;
            Pose turned;
            turned.direction = -poses[i].direction;
            turned.offset =
                glm::dvec2(mask.width, mask.height) * static_cast<double>(cell_) - poses[i].offset;
            turned.mask = half_turned(mask);
            prepare(turned);
            poses.push_back(std::move(turned));
        }
    }
    /// Masks with so few rows, which may be many, slide without their lower border.
    static constexpr int max_unbordered = 12;
    static void prepare(Pose& pose) {
        pose.coarse = coarser(pose.mask, search_level);
        if (pose.mask.height > max_unbordered) pose.lower = lower_border(pose.mask);
    }
    static bool is_full(const CellMask& mask) {
        return mask.runs.size() == static_cast<std::size_t>(mask.height) &&
               std::all_of(mask.runs.begin(), mask.runs.end(),
                           [&](const Run& run) { return run.end - run.begin == mask.width; });
    }

    bool place(std::uint32_t chart, const Rule& rule, CellMap& map) {
        double least = std::numeric_limits<double>::infinity();
        const std::size_t count = poses_[chart].size();
        // The pose of the last attempt comes first, because it bounds the search for the others.
        const std::size_t last = std::min(places_[chart].pose, count - 1);
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t i = k == 0 ? last : k <= last ? k - 1 : k;
            const Pose& pose = poses_[chart][i];
            int* const hint = hint_of(pose.coarse);
            // Higher positions cost more, even if charts slide down by one large cell.
            const double highest =
                (least - pose.mask.height) / (1.0 + rule.lower_weight) + (1 << search_level);
            const int end = static_cast<int>(std::min<double>(map.height(), highest));
            std::optional<CellMap::Position> at =
                map.find(pose.mask, pose.coarse, search_level, hint != nullptr ? *hint : 0, end);
            if (!at) continue;
            if (hint != nullptr) *hint = std::max(at->y - hint_slack, 0);
            at = map.slid(pose.mask, pose.lower, *at);
            const double cost =
                at->y + pose.mask.height + rule.lower_weight * at->y + rule.left_weight * at->x;
            if (cost >= least) continue;
            least = cost;
            places_[chart] = {i, *at, true};
        }
        if (std::isinf(least)) return false;
        occupy(chart, map);
        return true;
    }
    void occupy(std::uint32_t chart, CellMap& map) {
        const Place& place = places_[chart];
        const CellMask& mask = poses_[chart][place.pose].mask;
        map.occupy(mask, place.at);
        height_ = std::max(height_, place.at.y + mask.height);
    }
    /// The row to begin with for small charts of one size; null for others.
    int* hint_of(const CellMask& coarse) {
        if (std::max(coarse.width, coarse.height) > max_hinted_cells) return nullptr;
        return &hints_[static_cast<std::size_t>((coarse.width - 1) * max_hinted_cells +
                                                coarse.height - 1)];
    }

    PackingOptions options_;
    int cell_;
    double scale_ = 0.0;  ///< That all charts are prepared for, or 0.
    std::vector<std::vector<Outline>> outlines_;
    std::vector<std::vector<Pose>> poses_;
    std::vector<Place> places_;
    std::array<int, std::size_t{max_hinted_cells} * max_hinted_cells> hints_{};
    int height_ = 0;
    std::vector<double> areas_;
    Rule kept_rule_;
    std::vector<Place> kept_places_;
    int kept_rows_ = 0;  ///< 0: nothing is kept.
    std::size_t work_ = 0;
};

/// The area of charts with half of the padding, texels: a polynomial of the scale.
class PaddedArea {
  public:
    PaddedArea(std::span<const FlatChart> charts, std::span<const std::uint32_t> members,
               const PackingOptions& options) {
        // An eighth of its border, the side of a square, and cells at the border, covered in part.
        const Margin added = margin_of(options);
        const double corner = added.sum - added.side;
        const double margin =
            corner + std::sqrt(0.5) * (added.side - corner) + 0.5 * cell_of(options);
        for (const std::uint32_t member : members) {
            const FlatChart& chart = charts[member];
            square_ += chart.area;
            linear_ += 2.0 * (chart.size.x + chart.size.y) * margin;
            constant_ += 4.0 * margin * margin;
        }
    }
    [[nodiscard]] double at(double scale) const {
        return (square_ * scale + linear_) * scale + constant_;
    }
    /// Returns the scale for an area, which is above 0 even if there is none.
    [[nodiscard]] double scale_for(double area) const {
        const double rest = std::max(area - constant_, 0.02 * area);
        return 2.0 * rest / (linear_ + std::sqrt(linear_ * linear_ + 4.0 * square_ * rest));
    }

  private:
    double square_ = 0.0;
    double linear_ = 0.0;
    double constant_ = 0.0;
};

/// The rules of the first attempts, each with one of three orders.
class Rules {
  public:
    explicit Rules(std::span<const FlatChart> charts) : charts_(charts) {}

    static constexpr std::size_t count = 21;
    Rule rule(std::size_t index) {
        constexpr std::array<std::pair<double, double>, 7> weights{
            {{0.0, 0.0}, {1.0, 0.3}, {1.0, 1.0}, {0.0, 0.1}, {1.0, 0.0}, {0.0, 0.3}, {0.0, 1.0}}};
        const auto& [lower, left] = weights[index / 3 % weights.size()];
        return {order(index % 3), lower, left};
    }

  private:
    /// Most attempts to place many charts need one order only.
    const std::vector<std::uint32_t>& order(std::size_t index) {
        std::vector<std::uint32_t>& order = orders_[index];
        if (!order.empty()) return order;
        using Entry = std::pair<double, std::uint32_t>;
        std::vector<Entry> sizes;
        sizes.reserve(charts_.size());
        for (std::uint32_t i = 0; i < charts_.size(); ++i) {
            const FlatChart& chart = charts_[i];
            sizes.emplace_back(index == 0   ? std::max(chart.size.x, chart.size.y)
                               : index == 1 ? chart.size.x + chart.size.y
                                            : chart.area,
                               i);
        }
        std::sort(sizes.begin(), sizes.end(), [](const Entry& a, const Entry& b) {
            return a.first != b.first ? a.first > b.first : a.second < b.second;
        });
        order.reserve(sizes.size());
        for (const Entry& each : sizes)
            order.push_back(each.second);
        return order;
    }
    std::span<const FlatChart> charts_;
    std::array<std::vector<std::uint32_t>, 3> orders_;
};

/// Finds the rule of the next attempt after one that failed.
class RuleSearch {
  public:
    explicit RuleSearch(std::span<const FlatChart> charts) : rules_(charts) {}

    [[nodiscard]] Rule first() { return rules_.rule(0); }

    /// \param best  that leaves out least at the present scale. \param outcome  of it
    /// \param failures  at the present scale
    Rule next(const Rule& best, const Outcome& outcome, int failures) {
        if (failures % 2 == 1 && next_rule_ < Rules::count) return rules_.rule(next_rule_++);
        Rule rule = best;
        if (failures == 0 || random(2) == 0) {
            // A chart that was left out comes earlier.
            const std::size_t failed =
                outcome.left_out[failures == 0 ? 0 : random(outcome.left_out.size())];
            const std::size_t to = failures == 0 ? failed / 2 : random(failed + 1);
            const auto at = rule.order.begin() + static_cast<std::ptrdiff_t>(failed);
            std::rotate(rule.order.begin() + static_cast<std::ptrdiff_t>(to), at, at + 1);
        } else if (rule.order.size() > 1) {
            const std::size_t a = random(rule.order.size() - 1);
            const std::size_t b =
                a + 1 + random(std::min<std::size_t>(rule.order.size() - a - 1, 4));
            std::swap(rule.order[a], rule.order[b]);
        }
        if (random(8) == 0) {
            const Rule other = rules_.rule(random(Rules::count));
            rule.lower_weight = other.lower_weight;
            rule.left_weight = other.left_weight;
        }
        return rule;
    }

  private:
    /// Returns a number below `count`, the same in each run.
    std::size_t random(std::size_t count) {
        state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
        return static_cast<std::size_t>(state_ >> 33) % count;
    }

    Rules rules_;
    std::size_t next_rule_ = 1;
    std::uint64_t state_ = 1;
};

/// The largest scale at which every chart, upright or turned, is inside of a map.
double largest_scale(std::span<const FlatChart> charts, const glm::dvec2& size) {
    double scale = std::numeric_limits<double>::max();
    for (const FlatChart& chart : charts) {
        const double upright = std::min(size.x / chart.size.x, size.y / chart.size.y);
        const double turned = std::min(size.x / chart.size.y, size.y / chart.size.x);
        scale = std::min(scale, std::max(upright, turned));
    }
    return scale;
}

/// Packs the charts of a rule into a map of twice as many rows as they may need.
/// \param area  of these charts. \param texels_of_row  of the map
/// \return the share of the rows in use that charts and their padding cover; none if there is too
///         little room
std::optional<double> covered_share(Packer& packer, const Rule& rule, double scale,
                                    const PaddedArea& area, double texels_of_row, int rows) {
    packer.set_scale(scale, rule.order);
    if (!packer.pack(rule, 2 * rows, 0.0).left_out.empty()) return std::nullopt;
    return area.at(scale) / (texels_of_row * packer.height());
}

/// Returns charts of all sizes, each standing for `sample_share` ones.
std::vector<std::uint32_t> sample_of(std::span<const std::uint32_t> order) {
    std::vector<std::uint32_t> sample;
    for (std::size_t i = sample_share / 2; i < order.size(); i += sample_share)
        sample.push_back(order[i]);
    return sample;
}

/// Estimates the scale at which charts fill the map.
double estimated_scale(std::span<const FlatChart> charts, const PackingOptions& options,
                       double largest, Packer& packer, Rule rule) {
    const PaddedArea area(charts, rule.order, options);
    const double map_area = static_cast<double>(options.size.x) * options.size.y;
    const double first = std::min(area.scale_for(expected_use * map_area), largest);
    double longest = 0.0;
    for (const FlatChart& chart : charts)
        longest = std::max({longest, chart.size.x, chart.size.y});
    int rows = packer.rows();
    const int part = rows / static_cast<int>(sample_share);
    if (charts.size() >= min_sampled && part >= min_sampled_rows &&
        first * longest <= max_sampled_length * part * cell_of(options)) {
        rule.order = sample_of(rule.order);
        rows = part;
    }
    const std::optional<double> share =
        covered_share(packer, rule, first, PaddedArea(charts, rule.order, options),
                      map_area / packer.rows(), rows);
    if (!share) return 0.7 * first;
    const double estimate = area.scale_for(*share * map_area);
    return std::min(charts.size() > max_varied ? 0.985 * estimate : estimate, largest);
}

}  // namespace

Packing packed(std::span<const FlatChart> charts, const PackingOptions& options) {
    const double largest =
        largest_scale(charts, glm::dvec2(options.size) - 2.0 * margin_of(options).side);
    if (!(largest > 0.0)) throw InvalidInput("the padding leaves no room in the map");
    if (options.texels_per_unit && *options.texels_per_unit > largest)
        throw InvalidInput("the charts do not fit into the map at the requested density");
    const std::size_t attempts = attempts_for(charts.size(), options.texels_per_unit.has_value());
    ProgressStage stage("packing charts", attempts);
    Packer packer(charts, options, placing_cell_of(options, charts.size()));
    RuleSearch search(charts);
    Packing packing;
    Rule rule = search.first();
    const std::vector<std::uint32_t> all = rule.order;
    double scale = options.texels_per_unit
                       ? *options.texels_per_unit
                       : estimated_scale(charts, options, largest, packer, rule);
    double step = scale_step;
    Rule best = rule;
    std::optional<Outcome> least;  // Of `best` at this scale.
    int failures = 0;              // At this scale.
    int idle = 0;                  // Since `least` fell.
    int reductions = 0;            // Of the scale, before the first success.
    const int max_failures = static_cast<int>(std::clamp<std::size_t>(attempts / 3, 1, 21));
    // Attempts to place many charts end at the first one that does not fit.
    const double first_limit =
        charts.size() > max_varied ? 0.0 : std::numeric_limits<double>::infinity();
    const int rows = packer.rows();
    // Attempts that begin like earlier ones count less. The estimate is the first one.
    const std::size_t estimate = packer.work();
    std::size_t advanced = 0;
    for (std::size_t attempt = 1; attempt < attempts || packing.placements.empty();
         attempt = 1 + (packer.work() - estimate) / charts.size()) {
        for (; advanced < std::min(attempt, attempts); ++advanced)
            stage.advance(1);
        packer.set_scale(scale, all);
        const double limit = least ? least->left_out_area : first_limit;
        Outcome outcome = packer.pack(rule, rows, limit);
        if (outcome.left_out.empty()) {
            packing.texels_per_unit = scale;
            packing.placements.resize(charts.size());
            for (std::size_t i = 0; i < charts.size(); ++i)
                packing.placements[i] = packer.placement(i);
            if (options.texels_per_unit || scale >= largest) break;
            best = rule;
            scale = std::min(scale * (1.0 + step), largest);
        } else {
            ++idle;
            if (!least || outcome.left_out_area <= least->left_out_area) {
                if (least && outcome.left_out_area < least->left_out_area) idle = 0;
                if (outcome.left_out_area <= limit) packer.keep(rule, rows);
                best = rule;
                least = std::move(outcome);
            }
            rule = search.next(best, *least, failures);
            ++failures;
            if (idle < max_failures) continue;
            if (options.texels_per_unit)
                throw InvalidInput("the charts do not fit into the map at the requested density");
            if (!packing.placements.empty()) {
                step *= 0.5;
                if (step < min_scale_step) step = 0.5 * scale_step;
                scale = packing.texels_per_unit * (1.0 + step);
            } else {
                if (++reductions > max_reductions)
                    throw InvalidInput("the charts do not fit into the map");
                scale *= 1.0 - std::min(scale_step * (1 << std::min(reductions - 1, 5)), 0.25);
            }
            rule = best;
        }
        failures = 0;
        idle = 0;
        least.reset();
    }
    if (!options.texels_per_unit && charts.size() <= max_freely_rotated)
        raise_by_separation(charts, {options, margin_of(options), cell_of(options), largest},
                            packing);
    return packing;
}

glm::dvec2 placed(const glm::dvec2& point, const Placement& placement, double texels_per_unit) {
    return placement.offset + rotated(point * texels_per_unit, placement.direction);
}

}  // namespace relief::detail
