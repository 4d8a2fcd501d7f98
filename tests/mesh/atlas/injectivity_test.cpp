// SPDX-License-Identifier: Apache-2.0
// The proof that a chart does not overlap itself: each of its three conditions is needed.
#include "atlas/injectivity.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <utility>
#include <vector>

namespace relief {
using namespace relief::detail;

namespace {

/// A chart of triangles that are joined where they share an edge.
ChartMesh chart_of(const std::vector<glm::uvec3>& triangles) {
    ChartMesh chart;
    chart.faces.resize(triangles.size());
    std::iota(chart.faces.begin(), chart.faces.end(), 0U);
    chart.vertices = triangles;
    chart.opposite.assign(3 * triangles.size(), no_corner);
    std::map<std::pair<std::uint32_t, std::uint32_t>, Corner> edges;
    const auto end = [&](Corner corner, std::uint32_t i) {
        return triangles[corner / 3][static_cast<glm::length_t>((corner % 3 + i) % 3)];
    };
    for (Corner corner = 0; corner < chart.opposite.size(); ++corner)
        edges[{end(corner, 0), end(corner, 1)}] = corner;
    for (const auto& [ends, corner] : edges) {
        const auto other = edges.find({ends.second, ends.first});
        if (other != edges.end()) chart.opposite[corner] = other->second;
    }
    return chart;
}

/// A ring of `count` quadrilaterals between two loops of vertices: vertex i is inside, vertex
/// count + i outside.
ChartMesh ring(std::uint32_t count) {
    std::vector<glm::uvec3> triangles;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t next = (i + 1) % count;
        triangles.emplace_back(i, count + i, count + next);
        triangles.emplace_back(i, count + next, next);
    }
    return chart_of(triangles);
}

/// The corners of two squares around (100, 100).
std::vector<LatticePoint> square_loops(std::uint32_t turns) {
    const std::vector<LatticePoint> around = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    std::vector<LatticePoint> points;
    for (const int radius : {10, 40}) {
        for (std::uint32_t i = 0; i < 4 * turns; ++i)
            points.push_back(LatticePoint(100) + radius * around[i % 4]);
    }
    return points;
}

TEST(Injectivity, AcceptsARing) {
    EXPECT_EQ(overlap_in(ring(4), square_loops(1)), std::nullopt);
}

// All triangles are positive.
TEST(Injectivity, RefusesARingThatCoversTheMapTwice) {
    const ChartMesh chart = ring(8);
    std::vector<LatticePoint> points = square_loops(2);
    EXPECT_NE(overlap_in(chart, points), std::nullopt) << "the borders coincide";
    // A spiral of two turns that closes crosses itself.
    for (std::size_t i = 4; i < 8; ++i) {
        points[i] = LatticePoint(100) + (points[i] - LatticePoint(100)) * 2;
        points[8 + i] = LatticePoint(100) + (points[8 + i] - LatticePoint(100)) * 2;
    }
    EXPECT_NE(overlap_in(chart, points), std::nullopt);
}

// Two sheets above each other, a large and a small square, which are exchanged along a slit. All
// triangles are positive and the borders are apart, but both borders are counter-clockwise.
TEST(Injectivity, RefusesTwoPositiveLoops) {
    constexpr std::uint32_t side = 7;  // Vertices of the large sheet; the small one has 5.
    constexpr std::uint32_t slit_row = 3;
    std::vector<LatticePoint> points;
    for (int sheet = 0; sheet < 2; ++sheet) {
        for (std::uint32_t i = 0; i < side * side; ++i)
            points.emplace_back(20 * (i % side), 20 * (i / side));
    }
    // The slit runs from (2, 3) to (4, 3). Both sheets share its ends; in the middle, the upper
    // side of each sheet belongs to the lower side of the other.
    const auto vertex = [&](std::uint32_t sheet, std::uint32_t x, std::uint32_t y, bool is_above) {
        const bool is_end = y == slit_row && (x == 2 || x == 4);
        const bool is_middle = y == slit_row && x == 3;
        if (is_end) sheet = 0;
        if (is_middle && !is_above) sheet = 1 - sheet;
        return sheet * side * side + y * side + x;
    };
    std::vector<glm::uvec3> triangles;
    for (std::uint32_t sheet = 0; sheet < 2; ++sheet) {
        for (std::uint32_t y = sheet; y + 1 < side - sheet; ++y) {
            for (std::uint32_t x = sheet; x + 1 < side - sheet; ++x) {
                const bool is_above = y >= slit_row;
                const auto at = [&](std::uint32_t dx, std::uint32_t dy) {
                    return vertex(sheet, x + dx, y + dy, is_above);
                };
                triangles.emplace_back(at(0, 0), at(1, 0), at(1, 1));
                triangles.emplace_back(at(0, 0), at(1, 1), at(0, 1));
            }
        }
    }
    EXPECT_NE(overlap_in(chart_of(triangles), points), std::nullopt);
    // The large sheet alone is accepted.
    triangles.resize(2 * (side - 1) * (side - 1));
    for (glm::uvec3& triangle : triangles)
        triangle %= glm::uvec3(side * side);
    EXPECT_EQ(overlap_in(chart_of(triangles), points), std::nullopt);
}

TEST(Injectivity, RefusesInvertedAndFlatTriangles) {
    const ChartMesh chart = chart_of({{0, 1, 2}, {0, 2, 3}});
    EXPECT_EQ(overlap_in(chart, std::vector<LatticePoint>{{0, 0}, {9, 0}, {9, 9}, {0, 9}}),
              std::nullopt);
    EXPECT_EQ(overlap_in(chart, std::vector<LatticePoint>{{0, 0}, {9, 0}, {9, 9}, {5, 5}}), 1U)
        << "flat";
    EXPECT_EQ(overlap_in(chart, std::vector<LatticePoint>{{0, 0}, {9, 0}, {9, 9}, {9, 1}}), 1U)
        << "inverted";
}

// A strip of triangles that turns back over its beginning.
TEST(Injectivity, RefusesBordersThatTouch) {
    std::vector<glm::uvec3> triangles;
    for (std::uint32_t i = 0; i < 4; ++i) {
        triangles.emplace_back(2 * i, 2 * i + 1, 2 * i + 3);
        triangles.emplace_back(2 * i, 2 * i + 3, 2 * i + 2);
    }
    const ChartMesh chart = chart_of(triangles);
    // Inner and outer vertices around (100, 100), a quarter turn each, the last one back at the
    // first one but one unit inside or outside of it.
    const auto strip = [](int gap) {
        return std::vector<LatticePoint>{{110, 100 + gap}, {140, 100 + gap}, {100, 110}, {100, 140},
                                         {90, 100},        {60, 100},        {100, 90},  {100, 60},
                                         {110, 100 - gap}, {140, 100 - gap}};
    };
    EXPECT_EQ(overlap_in(chart, strip(1)), std::nullopt);
    EXPECT_NE(overlap_in(chart, strip(0)), std::nullopt) << "both ends coincide";
    EXPECT_NE(overlap_in(chart, strip(-1)), std::nullopt) << "the ends overlap";
}

// A vertex around which the triangles turn twice.
TEST(Injectivity, RefusesAFanOfTwoTurns) {
    std::vector<glm::uvec3> triangles;
    for (std::uint32_t i = 0; i < 8; ++i)
        triangles.emplace_back(0, 1 + i, 1 + (i + 1) % 8);
    std::vector<LatticePoint> points = {{100, 100}};
    const std::vector<LatticePoint> around = {{50, 0}, {0, 50}, {-50, 0}, {0, -50}};
    for (std::size_t i = 0; i < 8; ++i)
        points.push_back(LatticePoint(100) + around[i % 4]);
    EXPECT_NE(overlap_in(chart_of(triangles), points), std::nullopt);
}

TEST(Injectivity, RefusesAClosedSurface) {
    const ChartMesh chart = chart_of({{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}});
    const std::vector<LatticePoint> points = {{0, 0}, {9, 0}, {0, 9}, {3, 3}};
    EXPECT_NE(overlap_in(chart, points), std::nullopt);
}

}  // namespace
}  // namespace relief
