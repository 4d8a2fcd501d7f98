// SPDX-License-Identifier: Apache-2.0
// Charts are bit masks of cells: all cells that a chart touches when half of the padding is added
// around it. Charts that share no cell therefore keep their distance. For one row of positions, all
// columns are tested at once: a position is blocked if a run of cells of the chart meets an
// occupied cell.
#include "atlas/packing.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numeric>

#include "parallel.h"
#include "progress_stage.h"

namespace relief::detail {
namespace {

/// The number of packs after which the best scale is good enough, and after which packing fails.
constexpr int min_attempts = 7;
constexpr int max_attempts = 400;
constexpr double scale_tolerance = 0.003;

using Word = std::uint64_t;

/// Rows of bits. Bit x of a row is bit x % 64 of word x / 64.
class Bits {
  public:
    Bits() = default;
    Bits(int width, int height)
        : width_(width),
          height_(height),
          words_((static_cast<std::size_t>(width) + 63) / 64),
          bits_(words_ * static_cast<std::size_t>(height), 0) {}

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] std::size_t words() const { return words_; }
    [[nodiscard]] Word* row(int y) { return bits_.data() + words_ * static_cast<std::size_t>(y); }
    [[nodiscard]] const Word* row(int y) const {
        return bits_.data() + words_ * static_cast<std::size_t>(y);
    }
    [[nodiscard]] bool get(int x, int y) const { return (row(y)[x / 64] >> (x % 64) & 1) != 0; }
    void set(int x, int y) { row(y)[x / 64] |= Word{1} << (x % 64); }
    void set_run(int begin, int end, int y) {
        Word* const words = row(y);
        const int first = begin / 64;
        const int last = (end - 1) / 64;
        const Word head = ~Word{0} << (begin % 64);
        const Word tail = ~Word{0} >> (63 - (end - 1) % 64);
        if (first == last) {
            words[first] |= head & tail;
            return;
        }
        words[first] |= head;
        for (int i = first + 1; i < last; ++i)
            words[i] = ~Word{0};
        words[last] |= tail;
    }
    void add_rows(int height) {
        height_ += height;
        bits_.resize(words_ * static_cast<std::size_t>(height_), 0);
    }

  private:
    int width_ = 0;
    int height_ = 0;
    std::size_t words_ = 0;
    std::vector<Word> bits_;
};

/// Cells [begin, end) of a row.
struct Run {
    int begin, end;
};

/// The cells of a chart in one of four rotations.
struct Mask {
    Bits bits;
    std::vector<std::vector<Run>> runs;  ///< Of each row.
    int cell_count = 0;
    bool is_full = false;  ///< All cells of the box are set.
};

void find_runs(Mask& mask) {
    mask.runs.resize(static_cast<std::size_t>(mask.bits.height()));
    mask.cell_count = 0;
    for (int y = 0; y < mask.bits.height(); ++y) {
        std::vector<Run>& runs = mask.runs[static_cast<std::size_t>(y)];
        runs.clear();
        for (int x = 0; x < mask.bits.width();) {
            if (!mask.bits.get(x, y)) {
                ++x;
                continue;
            }
            const int begin = x;
            while (x < mask.bits.width() && mask.bits.get(x, y))
                ++x;
            runs.push_back({begin, x});
            mask.cell_count += x - begin;
        }
    }
    mask.is_full = mask.cell_count == mask.bits.width() * mask.bits.height();
}

/// Adds the cells that a triangle touches, with a margin around it.
void add_triangle(const std::array<glm::dvec2, 3>& p, double margin, double cell, Bits& bits) {
    const double low_y = std::min({p[0].y, p[1].y, p[2].y});
    const double high_y = std::max({p[0].y, p[1].y, p[2].y});
    const int first = std::max(static_cast<int>(std::floor((low_y - margin) / cell)), 0);
    const int last =
        std::min(static_cast<int>(std::floor((high_y + margin) / cell)), bits.height() - 1);
    for (int row = first; row <= last; ++row) {
        const double y0 = row * cell - margin;
        const double y1 = (row + 1) * cell + margin;
        double low = std::numeric_limits<double>::infinity();
        double high = -low;
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec2& a = p[i];
            const glm::dvec2& b = p[(i + 1) % 3];
            if (a.y >= y0 && a.y <= y1) {
                low = std::min(low, a.x);
                high = std::max(high, a.x);
            }
            for (const double y : {y0, y1}) {
                if ((a.y < y) == (b.y < y)) continue;
                const double x = a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
                low = std::min(low, x);
                high = std::max(high, x);
            }
        }
        if (!(low <= high)) continue;
        const int begin = std::max(static_cast<int>(std::floor((low - margin) / cell)), 0);
        const int end =
            std::min(static_cast<int>(std::floor((high + margin) / cell)) + 1, bits.width());
        if (begin < end) bits.set_run(begin, end, row);
    }
}

/// Half of the padding, and a little for the rounding of coordinates.
double margin_of(const PackingOptions& options) {
    return 0.5 * options.padding + 1e-3;
}

/// The cells of a chart whose box begins at the margin.
Mask mask_of(const FlatChart& chart, double scale, double margin, int cell) {
    const auto cells = [&](double length) {
        return std::max(static_cast<int>(std::ceil((length * scale + 2.0 * margin) / cell)), 1);
    };
    Mask mask;
    mask.bits = Bits(cells(chart.size.x), cells(chart.size.y));
    const auto point = [&](std::uint32_t vertex) {
        return chart.coordinates[vertex] * scale + margin;
    };
    for (const glm::uvec3& v : chart.mesh.vertices)
        add_triangle({point(v.x), point(v.y), point(v.z)}, margin, cell, mask.bits);
    find_runs(mask);
    return mask;
}

/// Rotates a mask counter-clockwise (y up).
Mask turned(const Mask& mask) {
    Mask result;
    result.bits = Bits(mask.bits.height(), mask.bits.width());
    for (int y = 0; y < mask.bits.height(); ++y) {
        for (const Run& run : mask.runs[static_cast<std::size_t>(y)])
            for (int x = run.begin; x < run.end; ++x)
                result.bits.set(mask.bits.height() - 1 - y, x);
    }
    find_runs(result);
    return result;
}

/// bits[x] |= bits[x + distance], for all x.
void or_shifted_down(std::vector<Word>& bits, int distance) {
    const auto words = static_cast<std::size_t>(distance / 64);
    const int rest = distance % 64;
    for (std::size_t i = 0; i + words < bits.size(); ++i) {
        const Word low = bits[i + words] >> rest;
        const Word high =
            rest != 0 && i + words + 1 < bits.size() ? bits[i + words + 1] << (64 - rest) : 0;
        bits[i] |= low | high;
    }
}

/// A map of cells with a width and as many rows as charts need.
class CellMap {
  public:
    explicit CellMap(int width) : bits_(width, 0), blocked_(bits_.words()), row_(bits_.words()) {}

    struct Position {
        int x, y;
    };

    /// Finds the lowest position, and the leftmost one in that row.
    /// \param first  the row to begin with. \param end  the rows before which to stop
    std::optional<Position> find(const Mask& mask, int first, int end) {
        const int free = bits_.width() - mask.bits.width() + 1;
        if (free <= 0) return std::nullopt;
        for (int y = first; y < end; ++y) {
            if (y + mask.bits.height() > bits_.height())
                bits_.add_rows(y + mask.bits.height() - bits_.height());
            if (const std::optional<int> x = free_column(mask, y, free)) return Position{*x, y};
        }
        return std::nullopt;
    }

    void occupy(const Mask& mask, const Position& at) {
        for (int y = 0; y < mask.bits.height(); ++y) {
            for (const Run& run : mask.runs[static_cast<std::size_t>(y)])
                bits_.set_run(at.x + run.begin, at.x + run.end, at.y + y);
        }
        height_ = std::max(height_, at.y + mask.bits.height());
    }
    [[nodiscard]] int height() const { return height_; }

  private:
    std::optional<int> free_column(const Mask& mask, int y, int free) {
        std::fill(blocked_.begin(), blocked_.end(), 0);
        const auto free_words = static_cast<std::size_t>((free + 63) / 64);
        // Positions beyond the last one are blocked.
        if (free % 64 != 0) blocked_[free_words - 1] = ~Word{0} << (free % 64);
        // From the middle outwards the widest rows come first, which block the most.
        const int height = mask.bits.height();
        for (int i = 0; i < height; ++i) {
            const int offset = height / 2 + (i % 2 == 0 ? i / 2 : -(i / 2) - 1);
            const int row = std::clamp(offset, 0, height - 1);
            block(mask.runs[static_cast<std::size_t>(row)], y + row);
            if (std::all_of(blocked_.begin(),
                            blocked_.begin() + static_cast<std::ptrdiff_t>(free_words),
                            [](Word word) { return word == ~Word{0}; }))
                return std::nullopt;
        }
        for (std::size_t i = 0; i < free_words; ++i) {
            if (blocked_[i] != ~Word{0})
                return static_cast<int>(i * 64) + std::countr_one(blocked_[i]);
        }
        return std::nullopt;
    }
    /// Blocks the positions at which the runs of a row meet occupied cells.
    void block(const std::vector<Run>& runs, int y) {
        const Word* const occupied = bits_.row(y);
        if (std::all_of(occupied, occupied + bits_.words(), [](Word word) { return word == 0; }))
            return;
        for (const Run& run : runs) {
            row_.assign(occupied, occupied + bits_.words());
            // Bit x becomes the union of the bits from x to x + length - 1.
            int covered = 1;
            const int length = run.end - run.begin;
            while (covered < length) {
                const int step = std::min(covered, length - covered);
                or_shifted_down(row_, step);
                covered += step;
            }
            const auto words = static_cast<std::size_t>(run.begin / 64);
            const int rest = run.begin % 64;
            for (std::size_t i = 0; i + words < row_.size(); ++i) {
                const Word low = row_[i + words] >> rest;
                const Word high = rest != 0 && i + words + 1 < row_.size()
                                      ? row_[i + words + 1] << (64 - rest)
                                      : 0;
                blocked_[i] |= low | high;
            }
        }
    }

    Bits bits_;
    int height_ = 0;
    std::vector<Word> blocked_;
    std::vector<Word> row_;
};

struct CellPlacement {
    int turns = 0;
    CellMap::Position at{0, 0};
    int height = 0;  ///< Of the mask before it was turned.
    int width = 0;
};

/// The charts at one scale, in cells.
class CellPacker {
  public:
    CellPacker(std::span<const FlatChart> charts, double scale, const PackingOptions& options,
               int cell)
        : options_(options), cell_(cell), masks_(charts.size()), placements_(charts.size()) {
        parallel_for(charts.size(), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                masks_[i] = mask_of(charts[i], scale, margin_of(options), cell);
        });
    }

    /// \return whether all charts fit into a map of this many rows
    bool pack(int max_rows) {
        CellMap map(options_.size.x / cell_);
        std::vector<std::uint32_t> order(masks_.size());
        std::iota(order.begin(), order.end(), 0U);
        const auto longest = [&](std::uint32_t i) {
            return std::max(masks_[i].bits.width(), masks_[i].bits.height());
        };
        std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            if (longest(a) != longest(b)) return longest(a) > longest(b);
            return masks_[a].cell_count > masks_[b].cell_count;
        });
        // For masks without gaps, the row below which there is no position for them.
        std::map<std::pair<int, int>, int> lowest;
        for (const std::uint32_t index : order) {
            check_cancelled();
            std::array<Mask, 4> turns;
            turns[0] = masks_[index];
            const int count =
                turns[0].is_full ? (turns[0].bits.width() == turns[0].bits.height() ? 1 : 2) : 4;
            for (std::size_t k = 1; k < static_cast<std::size_t>(count); ++k)
                turns[k] = turned(turns[k - 1]);
            std::optional<CellPlacement> best;
            int best_top = max_rows + 1;
            for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
                const Mask& mask = turns[k];
                const std::pair key(mask.bits.width(), mask.bits.height());
                const auto known = mask.is_full ? lowest.find(key) : lowest.end();
                const int first = known == lowest.end() ? 0 : known->second;
                // A position must have a lower upper edge than the best one.
                const auto at = map.find(mask, first, best_top - mask.bits.height());
                if (!at) continue;
                if (mask.is_full) lowest[key] = at->y;
                best = CellPlacement{static_cast<int>(k), *at, turns[0].bits.height(),
                                     turns[0].bits.width()};
                best_top = at->y + mask.bits.height();
            }
            if (!best) return false;
            map.occupy(turns[static_cast<std::size_t>(best->turns)], best->at);
            placements_[index] = *best;
        }
        height_ = map.height();
        return true;
    }
    [[nodiscard]] int height() const { return height_; }

    /// Returns the position of a chart after pack().
    [[nodiscard]] Placement placement(std::size_t index) const {
        const CellPlacement& each = placements_[index];
        const double margin = margin_of(options_);
        // The mask begins at the margin before the chart; the origin is rotated with it.
        const double w = each.width * cell_;
        const double h = each.height * cell_;
        // Blocks of texels are counted from the upper edge of the map.
        const glm::dvec2 corner(each.at.x * cell_, each.at.y * cell_ + options_.size.y % cell_);
        switch (each.turns) {
            case 0:
                return {0, corner + glm::dvec2(margin)};
            case 1:
                return {1, corner + glm::dvec2(h - margin, margin)};
            case 2:
                return {2, corner + glm::dvec2(w - margin, h - margin)};
            default:
                return {3, corner + glm::dvec2(margin, w - margin)};
        }
    }

  private:
    PackingOptions options_;
    int cell_;
    std::vector<Mask> masks_;
    std::vector<CellPlacement> placements_;
    int height_ = 0;
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

}  // namespace

Packing packed(std::span<const FlatChart> charts, const PackingOptions& options) {
    Packing packing;
    double area = 0.0;
    for (const FlatChart& chart : charts)
        area += chart.area;
    const glm::dvec2 size(options.size);
    const int coarse = std::max(options.alignment, 8);
    const int fine = std::max(options.alignment, 4);
    const double largest = largest_scale(charts, size - 2.0 * margin_of(options));
    if (!(largest > 0.0)) throw InvalidInput("the padding leaves no room in the map");
    double scale = std::min(std::sqrt(0.7 * size.x * size.y / area), largest);
    const auto finish = [&](const CellPacker& packer) {
        packing.texels_per_unit = scale;
        packing.placements.resize(charts.size());
        for (std::size_t i = 0; i < charts.size(); ++i)
            packing.placements[i] = packer.placement(i);
        return packing;
    };
    if (options.texels_per_unit) {
        scale = *options.texels_per_unit;
        const bool is_larger = scale > largest;
        CellPacker packer(charts, std::min(scale, largest), options, fine);
        if (is_larger || !packer.pack(options.size.y / fine))
            throw InvalidInput("the charts do not fit into the map at the requested density");
        return finish(packer);
    }
    constexpr int unlimited = 1 << 20;
    for (int round = 0; round < 3; ++round) {
        CellPacker packer(charts, scale, options, coarse);
        if (!packer.pack(unlimited)) {
            scale *= 0.8;  // A chart is wider than the map.
            continue;
        }
        scale = std::min(scale * std::sqrt(size.y / (packer.height() * coarse)), largest);
    }
    // Bisects between a scale that fits and one that does not.
    double too_large = std::numeric_limits<double>::infinity();
    bool fits = false;
    for (int attempt = 0; attempt < max_attempts; ++attempt) {
        CellPacker packer(charts, scale, options, fine);
        if (packer.pack(options.size.y / fine)) {
            finish(packer);
            fits = true;
            if (too_large <= scale * (1.0 + scale_tolerance)) break;
            if (scale >= largest) break;
            scale =
                std::isinf(too_large) ? std::min(scale * 1.04, largest) : 0.5 * (scale + too_large);
        } else {
            too_large = scale;
            scale = fits ? 0.5 * (packing.texels_per_unit + scale) : scale * 0.97;
        }
        if (fits && attempt >= min_attempts) break;
    }
    if (!fits) throw InvalidInput("the charts do not fit into the map");
    return packing;
}

glm::dvec2 placed(const glm::dvec2& point, const Placement& placement, double texels_per_unit) {
    const glm::dvec2 p = point * texels_per_unit;
    switch (placement.quarter_turns) {
        case 0:
            return placement.offset + p;
        case 1:
            return placement.offset + glm::dvec2(-p.y, p.x);
        case 2:
            return placement.offset - p;
        default:
            return placement.offset + glm::dvec2(p.y, -p.x);
    }
}

}  // namespace relief::detail
