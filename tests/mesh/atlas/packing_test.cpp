// SPDX-License-Identifier: Apache-2.0
// Masks of charts, the map in which they find places, and packing. Masks and places are compared
// with those that loops over all cells find.
#include "atlas/packing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "atlas/cell_map.h"
#include "atlas/cell_mask.h"
#include "hard_cases/random_meshes.h"
#include "relief/mesh/unwrap.h"
#include "support/shapes.h"

namespace relief::detail {
namespace {

using test::Dice;

/// Returns a value from 0 to 1.
double unit(Dice& dice) {
    return 0.5 + 0.5 * static_cast<double>(dice.any_digits());
}

bool contains(const CellMask& mask, int x, int y) {
    if (x < 0 || y < 0 || x >= mask.width || y >= mask.height) return false;
    const auto runs = mask.row(y);
    return std::any_of(runs.begin(), runs.end(),
                       [&](const Run& run) { return run.begin <= x && x < run.end; });
}

/// Appends a star-shaped loop around a center.
void append_loop(const glm::dvec2& center, const std::vector<double>& radii, bool is_clockwise,
                 std::vector<BorderSegment>& border) {
    const auto point = [&](std::size_t i) {
        const double turn = 2.0 * std::numbers::pi * static_cast<double>(i % radii.size()) /
                            static_cast<double>(radii.size());
        return center + radii[i % radii.size()] * glm::dvec2(std::cos(turn), std::sin(turn));
    };
    for (std::size_t i = 0; i < radii.size(); ++i) {
        if (is_clockwise)
            border.emplace_back(point(i + 1), point(i));
        else
            border.emplace_back(point(i), point(i + 1));
    }
}

/// A jagged disk with a round hole within [0, 100] x [0, 100].
std::vector<BorderSegment> jagged_ring(Dice& dice) {
    std::vector<double> outer(37);
    for (double& each : outer)
        each = 35.0 + 14.0 * unit(dice);
    std::vector<BorderSegment> border;
    append_loop({50.0, 50.0}, outer, false, border);
    append_loop({50.0, 50.0}, std::vector<double>(20, 15.0), true, border);
    return border;
}

double distance(const glm::dvec2& p, const BorderSegment& segment) {
    const glm::dvec2 edge = segment.second - segment.first;
    const double t = std::clamp(glm::dot(p - segment.first, edge) / glm::dot(edge, edge), 0.0, 1.0);
    return glm::length(p - segment.first - t * edge);
}

bool is_inside(const glm::dvec2& p, const std::vector<BorderSegment>& border) {
    bool result = false;
    for (const auto& [a, b] : border) {
        if ((a.y <= p.y) == (b.y <= p.y)) continue;
        if (p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)) result = !result;
    }
    return result;
}

TEST(CellMask, HasTheCellsNearTheChartAndNoOthers) {
    Dice dice(3);
    for (const int cell : {1, 2, 4}) {
        const std::vector<BorderSegment> border = jagged_ring(dice);
        const double margin = 2.0;
        const CellMask mask = mask_of(border, {100.0, 100.0}, margin, cell);
        for (int sample = 0; sample < 20000; ++sample) {
            const glm::dvec2 at(104.0 * unit(dice), 104.0 * unit(dice));
            const glm::dvec2 p = at - margin;
            double least = 1e9;
            for (const BorderSegment& segment : border)
                least = std::min(least, distance(p, segment));
            const bool is_set =
                contains(mask, static_cast<int>(at.x) / cell, static_cast<int>(at.y) / cell);
            if (is_inside(p, border) || least <= margin) {
                EXPECT_TRUE(is_set) << p.x << ' ' << p.y << ", cell " << cell;
            } else if (least > std::sqrt(2.0) * (margin + cell)) {
                EXPECT_FALSE(is_set) << p.x << ' ' << p.y << ", cell " << cell;
            }
        }
    }
}

TEST(CellMask, TurnsAndGetsCoarser) {
    Dice dice(4);
    const CellMask mask = mask_of(jagged_ring(dice), {100.0, 100.0}, 1.0, 1);
    const CellMask turned = half_turned(mask);
    const CellMask coarse = coarser(mask, 2);
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x) {
            EXPECT_EQ(contains(turned, mask.width - 1 - x, mask.height - 1 - y),
                      contains(mask, x, y));
            if (contains(mask, x, y)) {
                EXPECT_TRUE(contains(coarse, x / 4, y / 4));
            }
        }
    }
    std::size_t new_cells = 0;
    for (const RowRun& run : lower_border(mask)) {
        for (int x = run.begin; x < run.end; ++x, ++new_cells) {
            EXPECT_TRUE(contains(mask, x, run.y));
            EXPECT_FALSE(contains(mask, x, run.y - 1));
        }
    }
    std::size_t expected = 0;
    for (int y = 0; y < mask.height; ++y)
        for (int x = 0; x < mask.width; ++x)
            expected += contains(mask, x, y) && !contains(mask, x, y - 1) ? 1 : 0;
    EXPECT_EQ(new_cells, expected);
}

/// A map of cells without any acceleration.
struct PlainMap {
    int width, height;
    std::vector<bool> cells = std::vector<bool>(static_cast<std::size_t>(width * height), false);

    [[nodiscard]] bool get(int x, int y) const {
        return cells[static_cast<std::size_t>(y * width + x)];
    }
    [[nodiscard]] bool is_free(const CellMask& mask, int x, int y) const {
        if (x < 0 || y < 0 || x + mask.width > width || y + mask.height > height) return false;
        for (int row = 0; row < mask.height; ++row)
            for (const Run& run : mask.row(row))
                for (int i = run.begin; i < run.end; ++i)
                    if (get(x + i, y + row)) return false;
        return true;
    }
    void occupy(const CellMask& mask, int x, int y) {
        for (int row = 0; row < mask.height; ++row)
            for (const Run& run : mask.row(row))
                for (int i = run.begin; i < run.end; ++i)
                    cells[static_cast<std::size_t>((y + row) * width + x + i)] = true;
    }
    /// The same on cells 2^level times as large.
    [[nodiscard]] PlainMap coarser(int level) const {
        const int side = 1 << level;
        PlainMap result{(width + side - 1) / side, (height + side - 1) / side};
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                if (get(x, y))
                    result.cells[static_cast<std::size_t>(y / side * result.width + x / side)] =
                        true;
        return result;
    }
};

TEST(CellMap, FindsTheLowestPositionAndSlides) {
    Dice dice(5);
    CellMap map(301, 400, 3);
    PlainMap plain{301, 400};
    for (int i = 0; i < 60; ++i) {
        const double scale = 0.1 + 0.5 * unit(dice);
        std::vector<BorderSegment> border;
        for (const auto& [a, b] : jagged_ring(dice))
            border.emplace_back(a * scale, b * scale);
        const CellMask mask = mask_of(border, glm::dvec2(100.0 * scale), 1.0, 1);
        const int level = i % 2 + 1;
        const CellMask coarse = coarser(mask, level);
        const auto found = map.find(mask, coarse, level, 0, map.height());
        const PlainMap large = plain.coarser(level);
        bool is_known = false;
        for (int y = 0; y < large.height && !is_known; ++y) {
            for (int x = 0; x < large.width && !is_known; ++x) {
                if (!large.is_free(coarse, x, y)) continue;
                const int side = 1 << level;
                const int at_x = std::min(x * side, plain.width - mask.width);
                const int at_y = std::min(y * side, plain.height - mask.height);
                if (!plain.is_free(mask, at_x, at_y)) continue;
                is_known = true;
                ASSERT_TRUE(found.has_value()) << i;
                EXPECT_EQ(found->x, at_x) << i;
                EXPECT_EQ(found->y, at_y) << i;
            }
        }
        ASSERT_EQ(found.has_value(), is_known) << i;
        if (!found) continue;
        const CellMap::Position at = map.slid(mask, lower_border(mask), *found);
        EXPECT_LE(at.y, found->y);
        EXPECT_TRUE(plain.is_free(mask, at.x, at.y)) << i;
        EXPECT_FALSE(plain.is_free(mask, at.x, at.y - 1)) << i;
        EXPECT_FALSE(plain.is_free(mask, at.x - 1, at.y)) << i;
        map.occupy(mask, at);
        plain.occupy(mask, at.x, at.y);
    }
}

}  // namespace
}  // namespace relief::detail

namespace relief {
namespace {

TEST(Packing, FillsTheMap) {
    Mesh torus = make_torus(0.4F, 96, 48);
    torus.texcoords.clear();
    EXPECT_GT(unwrap(torus).stats.used, 0.6);
}

// A cancellation between two charts, long after the stage began.
TEST(Packing, CanBeCancelled) {
    const Mesh torus = make_torus(0.4F, 96, 48);
    Progress* running = nullptr;
    bool was_packing = false;
    Progress progress([&](const Progress::State& state) {
        if (state.stage != "packing charts" || !(state.part > 0.1)) return;
        was_packing = true;
        running->cancel();
    });
    running = &progress;
    UnwrapOptions options;
    options.execution.progress = &progress;
    EXPECT_THROW(unwrap(torus, options), Cancelled);
    EXPECT_TRUE(was_packing);
}

}  // namespace
}  // namespace relief
