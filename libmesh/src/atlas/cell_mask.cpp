// SPDX-License-Identifier: Apache-2.0
#include "atlas/cell_mask.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

namespace relief::detail {
namespace {

/// Rows of bits in which a chart is drawn.
class Canvas {
  public:
    Canvas(int width, int height) : width_(width), height_(height), words_(word_count(width)) {
        const std::size_t count = words_ * static_cast<std::size_t>(height);
        if (count > few_.size()) many_.resize(count, 0);
        bits_ = count > few_.size() ? many_.data() : few_.data();
    }
    Canvas(const Canvas&) = delete;
    Canvas& operator=(const Canvas&) = delete;

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] BitWord* row(int y) { return bits_ + words_ * static_cast<std::size_t>(y); }

    /// Inverts all cells of a row from `x` on.
    void invert_from(int x, int y) {
        if (x >= width_) return;
        BitWord* const words = row(y);
        auto i = static_cast<std::size_t>(x / word_bits);
        words[i] ^= ~BitWord{0} << (x % word_bits);
        for (++i; i < words_; ++i)
            words[i] = ~words[i];
    }

    [[nodiscard]] CellMask mask() const {
        CellMask mask;
        mask.width = width_;
        mask.height = height_;
        mask.runs.reserve(static_cast<std::size_t>(height_));
        mask.first.reserve(static_cast<std::size_t>(height_) + 1);
        mask.longest.reserve(static_cast<std::size_t>(height_));
        for (int y = 0; y < height_; ++y) {
            mask.first.push_back(static_cast<std::uint32_t>(mask.runs.size()));
            int longest = 0;
            const BitWord* const words = bits_ + words_ * static_cast<std::size_t>(y);
            for (int x = next_bit(words, 0, width_, true); x < width_;) {
                const int end = next_bit(words, x, width_, false);
                mask.runs.push_back({x, end});
                longest = std::max(longest, end - x);
                x = next_bit(words, end, width_, true);
            }
            mask.longest.push_back(static_cast<std::int16_t>(longest));
        }
        mask.first.push_back(static_cast<std::uint32_t>(mask.runs.size()));
        return mask;
    }

  private:
    int width_;
    int height_;
    std::size_t words_;
    BitWord* bits_;
    std::array<BitWord, 64> few_{};  ///< Small charts come by the thousands.
    std::vector<BitWord> many_;
};

/// Sets the cells that are within the margin of an edge.
void draw_edge(const glm::dvec2& a, const glm::dvec2& b, const Margin& margin, double cell,
               Canvas& canvas) {
    const glm::dvec2& low = a.y < b.y ? a : b;
    const glm::dvec2& high = a.y < b.y ? b : a;
    const int first = std::max(static_cast<int>(std::floor((low.y - margin.side) / cell)), 0);
    const int last =
        std::min(static_cast<int>(std::floor((high.y + margin.side) / cell)), canvas.height() - 1);
    const bool is_level = !(high.y > low.y);
    const double slope = is_level ? 0.0 : (high.x - low.x) / (high.y - low.y);
    // The points of the edge that reach furthest into a row from above and from below: on steep
    // edges where the margin begins to narrow, on others where it ends.
    const double reach = std::abs(slope) <= 1.0 ? margin.sum - margin.side : margin.side;
    for (int row = first; row <= last; ++row) {
        const double y0 = row * cell;
        const double y1 = (row + 1) * cell;
        const auto x_at = [&](double y) {
            if (y <= low.y) return low.x;
            return y >= high.y ? high.x : low.x + slope * (y - low.y);
        };
        // The margin on both sides of the point at `y`.
        const auto width_at = [&](double y) {
            const double beyond = std::max({y0 - y, y - y1, 0.0});
            return std::min(margin.side, margin.sum - std::min(beyond, margin.side));
        };
        const double y_below = std::clamp(y0 - reach, low.y, high.y);
        const double y_above = std::clamp(y1 + reach, low.y, high.y);
        const double below = is_level ? low.x : x_at(y_below);
        const double above = is_level ? high.x : x_at(y_above);
        const bool rises = above > below;
        const double left = rises ? below - width_at(y_below) : above - width_at(y_above);
        const double right = rises ? above + width_at(y_above) : below + width_at(y_below);
        const int begin = std::max(static_cast<int>(std::floor(left / cell)), 0);
        const int end = std::min(static_cast<int>(std::floor(right / cell)) + 1, canvas.width());
        if (begin < end) set_run(canvas.row(row), begin, end);
    }
}

/// Inverts the cells on the right side of an edge, for all rows whose middle it crosses. After all
/// edges of a chart, its inner cells are set. Cells at an edge may be wrong.
void invert_beyond(const glm::dvec2& a, const glm::dvec2& b, double cell, Canvas& canvas) {
    const glm::dvec2& low = a.y < b.y ? a : b;
    const glm::dvec2& high = a.y < b.y ? b : a;
    const int first = std::max(static_cast<int>(std::ceil(low.y / cell - 0.5)), 0);
    const double slope = high.y > low.y ? (high.x - low.x) / (high.y - low.y) : 0.0;
    for (int row = first; row < canvas.height(); ++row) {
        const double y = (row + 0.5) * cell;
        if (y < low.y) continue;
        if (y >= high.y) return;
        const double x = low.x + slope * (y - low.y);
        canvas.invert_from(std::max(static_cast<int>(std::floor(x / cell)), 0), row);
    }
}

}  // namespace

void set_run(BitWord* words, int begin, int end) {
    const int first = begin / word_bits;
    const int last = (end - 1) / word_bits;
    const BitWord head = ~BitWord{0} << (begin % word_bits);
    const BitWord tail = ~BitWord{0} >> (word_bits - 1 - (end - 1) % word_bits);
    if (first == last) {
        words[first] |= head & tail;
        return;
    }
    words[first] |= head;
    for (int i = first + 1; i < last; ++i)
        words[i] = ~BitWord{0};
    words[last] |= tail;
}

int next_bit(const BitWord* words, int x, int width, bool is_set) {
    for (; x < width; x = (x / word_bits + 1) * word_bits) {
        const BitWord word = is_set ? words[x / word_bits] : ~words[x / word_bits];
        const BitWord rest = word >> (x % word_bits);
        if (rest != 0) return std::min(x + std::countr_zero(rest), width);
    }
    return width;
}

CellMask mask_of(std::span<const BorderSegment> border, const glm::dvec2& size,
                 const Margin& margin, int cell, double scale) {
    const auto cells = [&](double length) {
        return std::max(
            static_cast<int>(std::ceil((length * scale + 2.0 * margin.side) / cell - 1e-6)), 1);
    };
    Canvas canvas(cells(size.x), cells(size.y));
    const glm::dvec2 shift(margin.side);
    for (const auto& [a, b] : border)
        invert_beyond(a * scale + shift, b * scale + shift, cell, canvas);
    for (const auto& [a, b] : border)
        draw_edge(a * scale + shift, b * scale + shift, margin, cell, canvas);
    return canvas.mask();
}

CellMask half_turned(const CellMask& mask) {
    CellMask result;
    result.width = mask.width;
    result.height = mask.height;
    result.runs.reserve(mask.runs.size());
    for (auto run = mask.runs.rbegin(); run != mask.runs.rend(); ++run)
        result.runs.push_back({mask.width - run->end, mask.width - run->begin});
    const auto count = static_cast<std::uint32_t>(mask.runs.size());
    for (auto first = mask.first.rbegin(); first != mask.first.rend(); ++first)
        result.first.push_back(count - *first);
    result.longest.assign(mask.longest.rbegin(), mask.longest.rend());
    return result;
}

CellMask coarser(const CellMask& mask, int level) {
    const int side = 1 << level;
    Canvas canvas((mask.width + side - 1) / side, (mask.height + side - 1) / side);
    for (int y = 0; y < mask.height; ++y) {
        for (const Run& run : mask.row(y))
            set_run(canvas.row(y / side), run.begin / side, (run.end - 1) / side + 1);
    }
    return canvas.mask();
}

std::vector<RowRun> lower_border(const CellMask& mask) {
    std::vector<RowRun> border;
    border.reserve(mask.runs.size());
    for (int y = 0; y < mask.height; ++y) {
        const std::span<const Run> below = y > 0 ? mask.row(y - 1) : std::span<const Run>();
        auto covered = below.begin();
        for (const Run& run : mask.row(y)) {
            int x = run.begin;
            while (covered != below.end() && covered->end <= x)
                ++covered;
            for (auto each = covered; each != below.end() && each->begin < run.end; ++each) {
                if (x < each->begin) border.push_back({y, x, each->begin});
                x = each->end;
            }
            if (x < run.end) border.push_back({y, x, run.end});
        }
    }
    return border;
}

}  // namespace relief::detail
