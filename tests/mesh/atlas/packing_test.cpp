// SPDX-License-Identifier: Apache-2.0
// Masks of charts, the map in which they find places, and packing. Masks and places are compared
// with those that loops over all cells find.
#include "atlas/packing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "atlas/cell_map.h"
#include "atlas/cell_mask.h"
#include "atlas/chart_outline.h"
#include "atlas/overlap_map.h"
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
        // The smallest cut square around a circle.
        const CellMask mask =
            mask_of(border, {100.0, 100.0}, {margin, std::sqrt(2.0) * margin}, cell);
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

// Margins of a diamond, of a circle that is cut to an octagon, and of a square.
TEST(CellMask, HasTheCellsOfItsMargin) {
    Dice dice(8);
    const double side = 3.0;
    for (const double sum : {side, std::sqrt(2.0) * side, 2.0 * side}) {
        const std::vector<BorderSegment> border = jagged_ring(dice);
        const CellMask mask = mask_of(border, {100.0, 100.0}, {side, sum}, 1);
        std::vector<glm::dvec2> points;
        for (const auto& [a, b] : border)
            for (int i = 0; i < 64; ++i)
                points.push_back(a + (b - a) * (i / 64.0));
        const auto is_within = [&](const glm::dvec2& offset, double more) {
            const glm::dvec2 size = glm::abs(offset);
            return std::max(size.x, size.y) <= side + more && size.x + size.y <= sum + 2.0 * more;
        };
        for (int sample = 0; sample < 20000; ++sample) {
            const glm::dvec2 offset =
                side * (2.0 * glm::dvec2(unit(dice), unit(dice)) - glm::dvec2(1.0));
            if (!is_within(offset, 0.0)) continue;
            const glm::dvec2& point = points[static_cast<std::size_t>(sample) % points.size()];
            const glm::dvec2 at = point + side + offset;
            EXPECT_TRUE(contains(mask, static_cast<int>(at.x), static_cast<int>(at.y)))
                << at.x << ' ' << at.y << ", sum " << sum;
        }
        // Cells reach half their side beyond their centers; points on edges are up to 0.2 apart.
        for (int y = 0; y < mask.height; ++y) {
            for (int x = 0; x < mask.width; ++x) {
                const glm::dvec2 p = glm::dvec2(x, y) + 0.5 - side;
                if (!contains(mask, x, y) || is_inside(p, border)) continue;
                EXPECT_TRUE(
                    std::any_of(points.begin(), points.end(),
                                [&](const glm::dvec2& each) { return is_within(each - p, 0.6); }))
                    << x << ' ' << y << ", sum " << sum;
            }
        }
    }
}

TEST(CellMask, TurnsAndGetsCoarser) {
    Dice dice(4);
    const CellMask mask = mask_of(jagged_ring(dice), {100.0, 100.0}, {1.0, 2.0}, 1);
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
        const CellMask mask = mask_of(border, glm::dvec2(100.0 * scale), {1.0, 2.0}, 1);
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

/// The least weighted number of shared cells in a row, by a loop over all cells.
OverlapMap::Best plain_best(const std::vector<PlainMap>& maps,
                            const std::vector<std::int32_t>& weights, const CellMask& mask, int y,
                            int begin, int end, int near_x) {
    OverlapMap::Best best{0, std::numeric_limits<std::int64_t>::max()};
    for (int x = std::max(begin, 0); x < std::min(end, maps[0].width - mask.width + 1); ++x) {
        std::int64_t cost = 0;
        for (std::size_t i = 0; i < maps.size(); ++i)
            for (int row = 0; row < mask.height; ++row)
                for (const Run& run : mask.row(row))
                    for (int cell = run.begin; cell < run.end; ++cell)
                        cost += maps[i].get(x + cell, y + row) ? weights[i] : 0;
        if (cost < best.cost ||
            (cost == best.cost && std::abs(x - near_x) < std::abs(best.x - near_x)))
            best = {x, cost};
    }
    return best;
}

TEST(OverlapMap, FindsTheBestPositionOfARow) {
    Dice dice(6);
    OverlapMap map(150, 130);
    std::vector<PlainMap> plain;
    std::vector<CellMask> masks;
    const std::vector<std::int32_t> weights{3, 0, 7, 1};
    for (std::uint32_t chart = 0; chart < weights.size(); ++chart) {
        masks.push_back(mask_of(jagged_ring(dice), {100.0, 100.0}, {1.0, 2.0}, 1));
        const int x = static_cast<int>(45.0 * unit(dice));
        const int y = static_cast<int>(25.0 * unit(dice));
        map.insert(chart, masks[chart], {x, y});
        plain.push_back({150, 130});
        plain[chart].occupy(masks[chart], x, y);
        if (chart != 0) continue;
        map.remove(chart, masks[chart], {x, y});
        map.insert(chart, masks[chart], {x, y});
    }
    std::vector<BorderSegment> border;
    for (const auto& [a, b] : jagged_ring(dice))
        border.emplace_back(a * 0.3, b * 0.3);
    const CellMask mask = mask_of(border, {30.0, 30.0}, {1.0, 2.0}, 1);
    for (const auto& [begin, end] : {std::pair(-5, 400), std::pair(20, 50), std::pair(100, 200)}) {
        for (int y = 0; y + mask.height <= 130; y += 7) {
            const OverlapMap::Best found =
                map.best_in_row(mask, {y, begin, end}, 1, weights, begin + 9);
            const OverlapMap::Best expected =
                plain_best(plain, weights, mask, y, begin, end, begin + 9);
            EXPECT_EQ(found.cost, expected.cost) << y;
            EXPECT_EQ(found.x, expected.x) << y;
        }
    }
}

/// A chart whose border is a star-shaped polygon around `center`.
FlatChart chart_of(const std::vector<glm::dvec2>& polygon, const glm::dvec2& center) {
    FlatChart chart;
    const auto count = static_cast<std::uint32_t>(polygon.size());
    chart.coordinates = polygon;
    chart.coordinates.push_back(center);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t next = (i + 1) % count;
        chart.mesh.faces.push_back(i);
        chart.mesh.vertices.emplace_back(i, next, count);
        chart.mesh.opposite.insert(chart.mesh.opposite.end(),
                                   {no_corner, 3 * next + 2, 3 * ((i + count - 1) % count) + 1});
        const glm::dvec2 a = polygon[i] - center;
        const glm::dvec2 b = polygon[next] - center;
        chart.area += 0.5 * (a.x * b.y - a.y * b.x);
        chart.size = glm::max(chart.size, polygon[i]);
    }
    return chart;
}

FlatChart random_chart(Dice& dice, double size) {
    std::vector<double> radii(16);
    for (double& each : radii)
        each = size * (0.2 + 0.3 * unit(dice));
    std::vector<BorderSegment> border;
    append_loop({0.5 * size, 0.5 * size}, radii, false, border);
    std::vector<glm::dvec2> polygon;
    for (const BorderSegment& each : border)
        polygon.push_back(each.first);
    return chart_of(polygon, {0.5 * size, 0.5 * size});
}

double used_share(const std::vector<FlatChart>& charts, const PackingOptions& options) {
    const double scale = packed(charts, options).texels_per_unit;
    double area = 0.0;
    for (const FlatChart& each : charts)
        area += each.area * scale * scale;
    return area / (static_cast<double>(options.size.x) * options.size.y);
}

// 16 squares with their padding fill the map if each has 60 texels: 87.9 %.
TEST(Packing, FillsTheMapWithSquares) {
    const FlatChart square = chart_of({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {0.5, 0.5});
    PackingOptions options;
    options.size = glm::ivec2(256);
    const double used = used_share(std::vector<FlatChart>(16, square), options);
    EXPECT_LE(used, 240.0 * 240.0 / (256.0 * 256.0));
    EXPECT_GT(used, 0.86);
}

// Two angles of three squares fill a rectangle if one of them is rotated into the notch of the
// other; boxes around them would fill at most 59 %.
TEST(Packing, FillsNotches) {
    const FlatChart angle = chart_of({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, {0.5, 0.5});
    PackingOptions options;
    options.size = {320, 480};
    EXPECT_GT(used_share({angle, angle}, options), 0.8);
}

// The mean of some sets, because results differ by one point by chance.
TEST(Packing, FillsTheMapWithRandomCharts) {
    PackingOptions options;
    options.size = glm::ivec2(1024);
    options.padding = 2;
    for (const auto& [count, expected] : {std::pair(12, 0.66), std::pair(150, 0.64)}) {
        const std::uint32_t sets = 4;
        double sum = 0.0;
        for (std::uint32_t set = 0; set < sets; ++set) {
            Dice dice(7 + set);
            std::vector<FlatChart> charts;
            for (int i = 0; i < count; ++i)
                charts.push_back(random_chart(dice, 0.5 + unit(dice)));
            sum += used_share(charts, options);
        }
        EXPECT_GT(sum / sets, expected) << count << " charts";
    }
}

/// The border of a packed chart, texels.
std::vector<BorderSegment> placed_border(const FlatChart& chart, const Packing& packing,
                                         std::size_t index) {
    const Outline outline = outline_of(chart, {1.0, 0.0});
    std::vector<BorderSegment> border;
    for (const auto& [a, b] : outline.border)
        border.emplace_back(
            placed(a + outline.low, packing.placements[index], packing.texels_per_unit),
            placed(b + outline.low, packing.placements[index], packing.texels_per_unit));
    return border;
}

// If two polygons don't intersect, a corner of one is nearest to the other.
double distance(const std::vector<BorderSegment>& a, const std::vector<BorderSegment>& b) {
    double least = std::numeric_limits<double>::infinity();
    for (const BorderSegment& first : a) {
        for (const BorderSegment& second : b) {
            least = std::min({least, distance(first.first, second), distance(second.first, first)});
        }
    }
    return least;
}

// Few charts are separated, many are only placed; both keep the distances, for a map that is not
// square and no multiple of the cells too.
TEST(Packing, KeepsThePadding) {
    for (const int count : {10, 90}) {
        for (const int padding : {0, 3, 8}) {
            Dice dice(static_cast<std::uint32_t>(count + padding));
            std::vector<FlatChart> charts;
            for (int i = 0; i < count; ++i)
                charts.push_back(random_chart(dice, 0.2 + unit(dice)));
            PackingOptions options;
            options.size = {701, 500};
            options.padding = padding;
            const Packing packing = packed(charts, options);
            std::vector<std::vector<BorderSegment>> borders;
            for (std::size_t i = 0; i < charts.size(); ++i)
                borders.push_back(placed_border(charts[i], packing, i));
            for (std::size_t i = 0; i < borders.size(); ++i) {
                for (const auto& [a, b] : borders[i]) {
                    EXPECT_GE(std::min(a.x, a.y), 0.5 * padding);
                    EXPECT_LE(a.x, options.size.x - 0.5 * padding);
                    EXPECT_LE(a.y, options.size.y - 0.5 * padding);
                }
                for (std::size_t j = 0; j < i; ++j) {
                    EXPECT_GE(distance(borders[i], borders[j]), padding)
                        << i << " and " << j << " of " << count << ", padding " << padding;
                    EXPECT_FALSE(is_inside(borders[i][0].first, borders[j]));
                    EXPECT_FALSE(is_inside(borders[j][0].first, borders[i]));
                }
            }
        }
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
