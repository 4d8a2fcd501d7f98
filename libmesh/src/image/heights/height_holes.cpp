// SPDX-License-Identifier: Apache-2.0
// The filling of holes: heights that are not finite, or transparent. A hole's value is the mean
// over the smallest square around it with a finite height. All squares inside that one hold none,
// so the mean runs over its rim alone; which rim, a chessboard distance map says
// [Rosenfeld and Pfaltz 1968]. Sums run in double in a fixed order around the rim.
// Tests: tests/mesh/image/bump/bump_test.cpp, heights/height_map_test.cpp.
#include "image/heights/height_holes.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "image/border.h"
#include "image/texel_loops.h"
#include "parallel.h"

namespace relief {
namespace {

/// A lattice of texels with what lies beyond its border.
struct Lattice {
    int width = 0;
    int height = 0;
    Wraps wrap;

    [[nodiscard]] std::size_t size() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }

    /// The texel at a place, or -1 where there is nothing.
    [[nodiscard]] std::ptrdiff_t at(int column, int row) const {
        const auto is_beyond = [](int place, int count, Wrap rule) {
            return rule == Wrap::clamp && (place < 0 || place >= count);
        };
        if (is_beyond(column, width, wrap.x) || is_beyond(row, height, wrap.y)) return -1;
        column = place_within(column, width, wrap.x);
        row = place_within(row, height, wrap.y);
        return static_cast<std::ptrdiff_t>(row) * width + column;
    }
};

/// One sweep of the distance map: every texel from the neighbours that the sweep has visited.
bool sweep(std::vector<std::uint32_t>& distance, const Lattice& lattice, int direction) {
    bool changed = false;
    const int rows = lattice.height;
    const int columns = lattice.width;
    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < columns; ++c) {
            const int row = direction > 0 ? r : rows - 1 - r;
            const int column = direction > 0 ? c : columns - 1 - c;
            std::uint32_t& own = distance[static_cast<std::size_t>(lattice.at(column, row))];
            const int visited[4][2] = {{-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
            for (const auto& step : visited) {
                const std::ptrdiff_t neighbour =
                    lattice.at(column + direction * step[0], row + direction * step[1]);
                if (neighbour < 0) continue;
                const std::uint32_t through = distance[static_cast<std::size_t>(neighbour)] + 1;
                if (through >= own) continue;
                own = through;
                changed = true;
            }
        }
    }
    return changed;
}

/// Chessboard distance of every texel to the nearest finite height. Two sweeps do for a bounded
/// image; a tiled one takes another round or two until nothing changes.
std::vector<std::uint32_t> distance_to_finite(std::span<const float> heights,
                                              const Lattice& lattice) {
    constexpr std::uint32_t far = std::uint32_t{1} << 31;
    std::vector<std::uint32_t> distance(heights.size());
    std::transform(heights.begin(), heights.end(), distance.begin(),
                   [](float height) { return std::isfinite(height) ? 0 : far; });
    bool changed = true;
    while (changed) {
        const bool forwards = sweep(distance, lattice, 1);
        const bool backwards = sweep(distance, lattice, -1);
        changed = forwards || backwards;
    }
    return distance;
}

/// The mean of the finite heights on the rim of a square.
float rim_mean(std::span<const float> heights, const Lattice& lattice, int column, int row,
               int radius) {
    double sum = 0.0;
    std::size_t count = 0;
    const auto take = [&](int c, int r) {
        const std::ptrdiff_t texel = lattice.at(c, r);
        if (texel < 0) return;
        const double height = heights[static_cast<std::size_t>(texel)];
        if (!std::isfinite(height)) return;
        sum += height;
        ++count;
    };
    for (int offset = -radius; offset <= radius; ++offset) {
        take(column + offset, row - radius);
        take(column + offset, row + radius);
    }
    for (int offset = 1 - radius; offset < radius; ++offset) {
        take(column - radius, row + offset);
        take(column + radius, row + offset);
    }
    return static_cast<float>(sum / static_cast<double>(count));
}

bool all_finite(std::span<const float> heights) {
    std::atomic<bool> finite = true;
    parallel_for(heights.size(), texels_per_piece, [&](std::size_t begin, std::size_t end) {
        // On the bits, since that loop is vectorised: infinities and NaN have all exponent bits
        // set.
        constexpr std::uint32_t exponent = 0x7F800000U;
        std::uint32_t found = 0;
        for (std::size_t texel = begin; texel < end; ++texel) {
            const auto bits = std::bit_cast<std::uint32_t>(heights[texel]);
            found |= static_cast<std::uint32_t>((bits & exponent) == exponent);
        }
        if (found != 0) finite = false;
    });
    return finite;
}

/// The heights, with NaN where there is none.
std::vector<float> without_transparent(std::span<const float> heights,
                                       std::span<const unsigned char> transparent) {
    std::vector<float> result(heights.begin(), heights.end());
    for (std::size_t texel = 0; texel < transparent.size(); ++texel) {
        if (transparent[texel] != 0) result[texel] = std::numeric_limits<float>::quiet_NaN();
    }
    return result;
}

}  // namespace

std::vector<float> filled_holes(const Image& height, const Wraps& wrap, Report& report,
                                const Transparency& transparency) {
    const std::span<const unsigned char> transparent = transparency.texels;
    if (transparent.empty() && all_finite(height.as<float>())) return {};
    const std::vector<float> heights = without_transparent(height.as<float>(), transparent);
    const auto is_transparent = [&](std::size_t texel) {
        return !transparent.empty() && transparent[texel] != 0;
    };
    const Lattice lattice{height.width, height.height, wrap};
    const std::vector<std::uint32_t> distance = distance_to_finite(heights, lattice);
    const auto farthest = static_cast<std::uint32_t>(std::max(height.width, height.height));
    const auto reach = static_cast<std::uint32_t>(transparency.reach);
    std::vector<float> whole = heights;
    parallel_for(lattice.size(), texels_per_piece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t texel = begin; texel < end; ++texel) {
            if (distance[texel] == 0) continue;
            const int column = static_cast<int>(texel % static_cast<std::size_t>(lattice.width));
            const int row = static_cast<int>(texel / static_cast<std::size_t>(lattice.width));
            const bool is_filled = distance[texel] <= (is_transparent(texel) ? reach : farthest);
            whole[texel] = is_filled ? rim_mean(heights, lattice, column, row,
                                                static_cast<int>(distance[texel]))
                                     : 0.0F;
        }
    });
    const bool has_heights =
        std::any_of(distance.begin(), distance.end(), [](std::uint32_t away) { return away == 0; });
    const char* const outcome = has_heights
                                    ? "read as the mean of the nearest finite heights"
                                    : "read as 0, as no height of the map is finite: it is flat";
    for (std::size_t texel = 0; texel < distance.size(); ++texel) {
        if (distance[texel] != 0 && !is_transparent(texel))
            report.add("non-finite height", "texel", texel, outcome);
    }
    return whole;
}

}  // namespace relief
