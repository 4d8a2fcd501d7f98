// SPDX-License-Identifier: Apache-2.0
#include "atlas/cell_map.h"

#include <algorithm>
#include <bit>

namespace relief::detail {
namespace {

bool meets_run(const BitWord* words, int begin, int end) {
    const int first = begin / word_bits;
    const int last = (end - 1) / word_bits;
    const BitWord head = ~BitWord{0} << (begin % word_bits);
    const BitWord tail = ~BitWord{0} >> (word_bits - 1 - (end - 1) % word_bits);
    if (first == last) return (words[first] & head & tail) != 0;
    if ((words[first] & head) != 0 || (words[last] & tail) != 0) return true;
    for (int i = first + 1; i < last; ++i)
        if (words[i] != 0) return true;
    return false;
}

}  // namespace

CellMap::CellMap(int width, int height, int level_count)
    : levels_(static_cast<std::size_t>(level_count)) {
    for (std::size_t i = 0; i < levels_.size(); ++i) {
        Level& level = levels_[i];
        const int side = 1 << i;
        level.width = (width + side - 1) / side;
        level.height = (height + side - 1) / side;
        level.words = word_count(std::max(level.width, 1)) + 1;
        const int tables = i == 0 ? 1 : std::bit_width(static_cast<unsigned>(level.width));
        level.tables.resize(static_cast<std::size_t>(tables));
    }
    blocked_.resize(levels_.front().words);
    clear();
}

void CellMap::clear() {
    for (Level& level : levels_) {
        for (std::vector<BitWord>& table : level.tables)
            table.assign(level.words * static_cast<std::size_t>(level.height + 1), 0);
        const auto height = static_cast<std::size_t>(level.height);
        level.longest_free.assign(height, {0, level.width});
        level.free_length.assign(height, static_cast<std::int16_t>(level.width));
    }
}

std::optional<CellMap::Position> CellMap::find(const CellMask& mask, const CellMask& coarse,
                                               int level_index, int first, int end) {
    const Level& level = levels_[static_cast<std::size_t>(level_index)];
    const int count = level.width - coarse.width + 1;
    if (count <= 0 || mask.width > width()) return std::nullopt;
    end = std::min(end, height() - mask.height + 1);
    const int last = std::min((end - 1) >> level_index, level.height - coarse.height);
    for (int y = first >> level_index; y <= last; ++y) {
        if (!has_room(coarse, level, y)) continue;
        const std::optional<int> x = free_column(coarse, level, y, count);
        if (!x) continue;
        // The last cells of a level may be larger than the rest of the map.
        const Position in_level{*x << level_index, y << level_index};
        const Position at{std::min(in_level.x, width() - mask.width),
                          std::min(in_level.y, height() - mask.height)};
        if ((at.x == in_level.x && at.y == in_level.y) || is_free(mask, at)) return at;
    }
    return std::nullopt;
}

bool CellMap::has_room(const CellMask& mask, const Level& level, int y) {
    const std::int16_t* const free = level.free_length.data() + y;
    const std::int16_t* const longest = mask.longest.data();
    // Loops without branches, which compilers vectorize.
    const auto have_room = [&](int begin, int end) {
        std::int16_t missing = 0;
        for (int row = begin; row < end; ++row)
            missing = static_cast<std::int16_t>(missing | (free[row] < longest[row] ? 1 : 0));
        return missing == 0;
    };
    // The middle rows are the longest ones of most charts.
    const int first = mask.height / 3;
    const int last = mask.height - first;
    return have_room(first, last) && have_room(0, first) && have_room(last, mask.height);
}

std::optional<int> CellMap::free_column(const CellMask& mask, const Level& level, int y,
                                        int count) {
    const std::size_t words = word_count(count);
    // Positions beyond the last one are blocked.
    std::fill_n(blocked_.begin(), words, BitWord{0});
    if (count % word_bits != 0) blocked_[words - 1] = ~BitWord{0} << (count % word_bits);
    // The words before `begin` and from `end` on are blocked.
    std::size_t begin = 0;
    std::size_t end = words;
    const auto blocks_all = [&](int row) {
        for (const Run& run : mask.row(row)) {
            // Two runs of 2^k cells cover it.
            const int length = run.end - run.begin;
            const int k = std::bit_width(static_cast<unsigned>(length)) - 1;
            const BitWord* const table = level.row(static_cast<std::size_t>(k), y + row);
            block(table, run.begin, begin, end);
            if (length != 1 << k) block(table, run.end - (1 << k), begin, end);
        }
        while (begin < end && blocked_[begin] == ~BitWord{0})
            ++begin;
        while (begin < end && blocked_[end - 1] == ~BitWord{0})
            --end;
        return begin == end;
    };
    // Rows near each other block nearly the same positions, so that rows far from each other come
    // first: the odd multiples of each power of two.
    for (int step = static_cast<int>(std::bit_floor(static_cast<unsigned>(mask.height))); step > 0;
         step /= 2) {
        for (int row = step; row < mask.height; row += 2 * step)
            if (blocks_all(row)) return std::nullopt;
    }
    if (blocks_all(0)) return std::nullopt;
    return static_cast<int>(begin) * word_bits + std::countr_one(blocked_[begin]);
}

void CellMap::block(const BitWord* table, int shift, std::size_t begin, std::size_t end) {
    // Words after the end of a row only matter for positions that are blocked anyway.
    const BitWord* const from = table + shift / word_bits;
    const int rest = shift % word_bits;
    for (std::size_t i = begin; i < end; ++i)
        blocked_[i] |= (from[i] >> rest) | (from[i + 1] << 1 << (word_bits - 1 - rest));
}

bool CellMap::is_free(const CellMask& mask, const Position& at) const {
    const Level& level = levels_.front();
    for (int y = 0; y < mask.height; ++y) {
        const BitWord* const words = level.row(0, at.y + y);
        for (const Run& run : mask.row(y))
            if (meets_run(words, at.x + run.begin, at.x + run.end)) return false;
    }
    return true;
}

CellMap::Position CellMap::slid(const CellMask& mask, std::span<const RowRun> lower,
                                Position at) const {
    const Level& level = levels_.front();
    const auto can_move_down = [&] {
        if (at.y == 0) return false;
        if (lower.empty()) return is_free(mask, {at.x, at.y - 1});
        return std::none_of(lower.begin(), lower.end(), [&](const RowRun& run) {
            return meets_run(level.row(0, at.y - 1 + run.y), at.x + run.begin, at.x + run.end);
        });
    };
    const auto can_move_left = [&] {
        if (at.x == 0) return false;
        for (int y = 0; y < mask.height; ++y) {
            const BitWord* const words = level.row(0, at.y + y);
            for (const Run& run : mask.row(y)) {
                const int x = at.x + run.begin - 1;
                if ((words[x / word_bits] >> (x % word_bits) & 1) != 0) return false;
            }
        }
        return true;
    };
    for (;;) {
        while (can_move_down())
            --at.y;
        const int x = at.x;
        while (can_move_left())
            --at.x;
        if (at.x == x) return at;
    }
}

void CellMap::occupy(const CellMask& mask, const Position& at) {
    for (std::size_t i = 0; i < levels_.size(); ++i) {
        Level& level = levels_[i];
        for (int y = 0; y < mask.height; ++y) {
            const int row = (at.y + y) >> i;
            for (const Run& run : mask.row(y))
                set_run(level.row(0, row), (at.x + run.begin) >> i,
                        ((at.x + run.end - 1) >> i) + 1);
        }
        if (i == 0) continue;
        for (int row = at.y >> i; row <= (at.y + mask.height - 1) >> i; ++row)
            renew_tables(level, row, {at.x >> i, ((at.x + mask.width - 1) >> i) + 1});
    }
}

void CellMap::renew_tables(Level& level, int y, const Run& changed) {
    for (std::size_t k = 0; k + 1 < level.tables.size(); ++k) {
        const BitWord* const from = level.row(k, y);
        BitWord* const to = level.row(k + 1, y);
        const int shift = 1 << k;
        const auto skipped = static_cast<std::size_t>(shift / word_bits);
        const int rest = shift % word_bits;
        const std::size_t words = level.words - 1;
        // Runs of 2 * shift cells that begin elsewhere don't reach the changed cells.
        const auto begin =
            static_cast<std::size_t>(std::max(changed.begin - 2 * shift + 1, 0) / word_bits);
        const std::size_t end = word_count(changed.end);
        for (std::size_t w = begin; w < end; ++w) {
            BitWord value = from[w];
            if (w + skipped < words)
                value |= (from[w + skipped] >> rest) |
                         (from[w + skipped + 1] << 1 << (word_bits - 1 - rest));
            to[w] = value;
        }
    }
    Run& longest = level.longest_free[static_cast<std::size_t>(y)];
    if (changed.end <= longest.begin || changed.begin >= longest.end) return;
    // The longest run of free cells: the gap between two runs of occupied ones.
    const BitWord* const words = level.row(0, y);
    longest = {0, 0};
    for (int x = next_bit(words, 0, level.width, false); x < level.width;) {
        const int end = next_bit(words, x, level.width, true);
        if (end - x > longest.end - longest.begin) longest = {x, end};
        x = next_bit(words, end, level.width, false);
    }
    level.free_length[static_cast<std::size_t>(y)] =
        static_cast<std::int16_t>(longest.end - longest.begin);
}

}  // namespace relief::detail
