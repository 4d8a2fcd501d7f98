// SPDX-License-Identifier: Apache-2.0
// Decimation of doubled walls, of layers of several materials, and of sheets that meet at
// non-manifold edges.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include "geometry/weld.h"
#include "mesh/topology/decimated_to.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/topology.h"

namespace relief {
namespace {

using test::decimated_to;

/// Adds a sheet of cells x cells squares with a wave of a small height.
template <typename Point>
void add_sheet(Mesh& mesh, std::uint32_t cells, const Point& point) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t y = 0; y <= cells; ++y) {
        for (std::uint32_t x = 0; x <= cells; ++x)
            mesh.positions.push_back(point(static_cast<float>(x) / static_cast<float>(cells),
                                           static_cast<float>(y) / static_cast<float>(cells)));
    }
    for (std::uint32_t y = 0; y < cells; ++y) {
        for (std::uint32_t x = 0; x < cells; ++x) {
            const std::uint32_t v = first + (cells + 1) * y + x;
            mesh.triangles.emplace_back(v, v + 1, v + cells + 2);
            mesh.triangles.emplace_back(v, v + cells + 2, v + cells + 1);
        }
    }
}

Mesh wave(std::uint32_t cells) {
    Mesh mesh;
    add_sheet(mesh, cells, [](float x, float y) {
        return glm::vec3(x, y, 0.1F * std::sin(7.0F * x) * std::cos(5.0F * y));
    });
    return mesh;
}

/// Adds the other sides of the first triangles.
Mesh with_backs(Mesh mesh, std::size_t count) {
    for (std::size_t t = 0; t < count; ++t) {
        const glm::uvec3 triangle = mesh.triangles[t];
        mesh.triangles.emplace_back(triangle.z, triangle.y, triangle.x);
    }
    return mesh;
}

using Points = std::array<std::array<float, 3>, 3>;

/// The corners of a triangle, beginning with the smallest one.
Points points_of(const Mesh& mesh, const glm::uvec3& triangle, bool is_turned = false) {
    Points points{};
    for (int i = 0; i < 3; ++i) {
        const glm::vec3& p = mesh.positions[triangle[is_turned ? 2 - i : i]];
        points[static_cast<std::size_t>(i)] = {p.x, p.y, p.z};
    }
    std::rotate(points.begin(), std::min_element(points.begin(), points.end()), points.end());
    return points;
}

std::multiset<Points> sides_of(const Mesh& mesh, bool is_turned) {
    std::multiset<Points> all;
    for (const glm::uvec3& triangle : mesh.triangles)
        all.insert(points_of(mesh, triangle, is_turned));
    return all;
}

/// The number of edges by position with one triangle only.
std::size_t open_edges(const Mesh& mesh) {
    const std::vector<std::uint32_t> classes = detail::weld_positions(mesh.positions);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const glm::uvec3& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i)
            ++uses[std::minmax(classes[t[i]], classes[t[(i + 1) % 3]])];
    }
    return static_cast<std::size_t>(
        std::count_if(uses.begin(), uses.end(), [](const auto& edge) { return edge.second == 1; }));
}

TEST(DecimateLayers, ADoubledWallIsReducedLikeASingleOne) {
    const Mesh single = wave(24);
    const Mesh both = with_backs(single, single.triangles.size());
    Report report;
    const Mesh expected = decimated_to(single, 200, report);
    EXPECT_TRUE(report.empty());
    const Mesh small = decimated_to(both, 400, report);
    EXPECT_EQ(small.triangles.size(), 2 * expected.triangles.size());
    EXPECT_EQ(sides_of(small, false), sides_of(small, true));
    EXPECT_EQ(report.count("double-sided triangle"), single.triangles.size());
    EXPECT_EQ(report.count("number of triangles out of reach"), 0U);
    const Mesh front = decimated_to(both, 400, report, NormalWeight::angle);
    for (const glm::uvec3& t : front.triangles) {
        const glm::vec3 a = front.positions[t.x];
        const glm::vec3 cross = glm::cross(front.positions[t.y] - a, front.positions[t.z] - a);
        for (int i = 0; i < 3; ++i)
            EXPECT_GT(glm::dot(front.normals[t[i]], cross), 0.0F);
    }
}

TEST(DecimateLayers, EachSideKeepsItsMaterialAndAttributes) {
    Mesh mesh = wave(24);
    const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
    const std::size_t triangles = mesh.triangles.size();
    mesh = with_backs(mesh, triangles);
    for (std::size_t t = triangles; t < mesh.triangles.size(); ++t)
        mesh.triangles[t] += vertices;
    for (std::uint32_t v = 0; v < vertices; ++v) {
        mesh.positions.push_back(mesh.positions[v]);
        mesh.colors.emplace_back(0.0F, 0.0F, 0.0F, 1.0F);
    }
    mesh.colors.resize(mesh.positions.size(), glm::vec4(1.0F));
    mesh.material_ranges = {
        {0, static_cast<std::uint32_t>(triangles), {}},
        {static_cast<std::uint32_t>(triangles), static_cast<std::uint32_t>(triangles), {}}};
    mesh.material_ranges[0].material = 0;
    mesh.material_ranges[1].material = 1;
    Report report;
    const Mesh small = decimated_to(mesh, 400, report);
    EXPECT_LE(small.triangles.size(), 400U);
    ASSERT_EQ(small.material_ranges.size(), 2U);
    EXPECT_EQ(small.material_ranges[0].triangle_count, small.material_ranges[1].triangle_count);
    for (std::size_t t = 0; t < small.triangles.size(); ++t) {
        const float expected = t < small.material_ranges[0].triangle_count ? 0.0F : 1.0F;
        for (int i = 0; i < 3; ++i)
            EXPECT_EQ(small.colors[small.triangles[t][i]].x, expected);
    }
    EXPECT_EQ(sides_of(small, false), sides_of(small, true));
}

TEST(DecimateLayers, APartlyDoubledWallKeepsTheBorderOfItsBack) {
    const Mesh single = wave(24);
    const Mesh mesh = with_backs(single, single.triangles.size() / 2);
    Report report;
    const Mesh small = decimated_to(mesh, 300, report);
    EXPECT_LE(small.triangles.size(), 300U);
    // Each back has its front, and both sheets still end at y = 0.5.
    const std::multiset<Points> sides = sides_of(small, false);
    std::size_t doubled = 0;
    for (const Points& turned : sides_of(small, true)) {
        if (sides.count(turned) == 0) continue;
        ++doubled;
        for (const auto& point : turned)
            EXPECT_LE(point[1], 0.5F);
    }
    EXPECT_GT(doubled, 0U);
    EXPECT_EQ(doubled % 2, 0U);
}

/// Three sheets that meet at a curve.
Mesh fin(std::uint32_t cells) {
    Mesh mesh;
    const auto curve = [](float y) { return glm::vec3(0.05F * std::sin(6.0F * y), y, 0.0F); };
    for (int i = 0; i < 3; ++i) {
        const double angle = 2.1 * i;
        const glm::vec3 outward(std::cos(angle), 0.0, std::sin(angle));
        add_sheet(mesh, cells, [&](float x, float y) { return curve(y) + x * outward; });
    }
    return mesh;
}

TEST(DecimateLayers, SheetsAtANonManifoldCurveStayTogether) {
    const Mesh mesh = fin(24);
    Report report;
    const Mesh small = decimated_to(mesh, 60, report);
    EXPECT_LE(small.triangles.size(), 60U);
    EXPECT_EQ(report.count("non-manifold edge"), 24U);
    EXPECT_EQ(report.count("number of triangles out of reach"), 0U);
    // The edges on the curve are those of three triangles; all others at it are inner ones.
    const std::vector<std::uint32_t> classes = detail::weld_positions(small.positions);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const glm::uvec3& t : small.triangles) {
        for (int i = 0; i < 3; ++i)
            ++uses[std::minmax(classes[t[i]], classes[t[(i + 1) % 3]])];
    }
    double length = 0.0;
    int edges = 0;
    for (const auto& [edge, count] : uses) {
        if (count != 3) continue;
        ++edges;
        length += std::abs(small.positions[edge.first].y - small.positions[edge.second].y);
    }
    EXPECT_NEAR(length, 1.0, 1e-6) << "no crack opens along the curve";
    EXPECT_LT(edges, 12);
    EXPECT_GE(open_edges(small), 3U);
}

TEST(DecimateLayers, TrianglesInTheSameDirectionStayTogether) {
    // Two sheets with opposite windings share an edge: the second one is seen from behind.
    Mesh mesh;
    add_sheet(mesh, 16, [](float x, float y) { return glm::vec3(x, y, 0.2F * x * x); });
    const std::size_t half = mesh.triangles.size();
    add_sheet(mesh, 16, [](float x, float y) { return glm::vec3(-x, y, 0.3F * x * x); });
    EXPECT_EQ(half, mesh.triangles.size() / 2);
    Report report;
    const Mesh small = decimated_to(mesh, 60, report);
    EXPECT_LE(small.triangles.size(), 60U);
    const std::size_t open = open_edges(small);
    // The border has no gap at the common edge, where each edge has two triangles.
    double border = 0.0;
    for (const glm::vec3& p : small.positions)
        border += p.x == 0.0F ? 1.0 : 0.0;
    EXPECT_GE(open, 6U);
    EXPECT_EQ(static_cast<int>(border) % 2, 0);
}

TEST(DecimateLayers, TheOrderOfTrianglesDoesNotMatter) {
    Mesh mesh = with_backs(fin(12), 500);
    for (std::size_t t = 100; t < 300; ++t)
        mesh.triangles.push_back(mesh.triangles[t]);
    Report report;
    const Mesh expected = decimated_to(mesh, 250, report);
    std::mt19937 random(5);
    for (int round = 0; round < 5; ++round) {
        Mesh mixed = mesh;
        std::shuffle(mixed.triangles.begin(), mixed.triangles.end(), random);
        for (glm::uvec3& t : mixed.triangles) {
            for (auto turns = random() % 3; turns > 0; --turns)
                t = glm::uvec3(t.y, t.z, t.x);
        }
        const Mesh small = decimated_to(mixed, 250, report);
        EXPECT_EQ(sides_of(small, false), sides_of(expected, false));
    }
}

}  // namespace
}  // namespace relief
