// SPDX-License-Identifier: Apache-2.0
// Half-edge topology and Loop subdivision. The topology of any triangles is manifold: an edge has
// at most two triangles and a vertex one fan. Subdivided points are compared with hand-computed
// values and limits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "geometry/weld.h"
#include "mesh/topology/boundary_edges.h"
#include "relief/mesh/report.h"
#include "relief/mesh/topology.h"
#include "support/invariants.h"
#include "support/shapes.h"
#include "topology/topology.h"

namespace relief {
using namespace relief::detail;

namespace {

using test::boundary_edges;
using test::mesh_from;
using test::message_of;

constexpr double subdivide_rounding = 1e-6;

TEST(Subdivide, ATetrahedronByHand) {
    Mesh tetrahedron;
    tetrahedron.positions = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    tetrahedron.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    Report report;
    const Mesh fine = subdivided(tetrahedron, 1, {}, report);
    ASSERT_EQ(fine.positions.size(), 10U);
    ASSERT_EQ(fine.triangles.size(), 16U);
    EXPECT_TRUE(fine.normals.empty()) << "there were none";
    // Three neighbors weigh 3/16 each. Their sum is the negative vertex: 7/16 - 3/16.
    for (int v = 0; v < 4; ++v)
        EXPECT_LT(glm::length(fine.positions[v] - tetrahedron.positions[v] * 0.25F),
                  subdivide_rounding);
    // 3/8 of both ends and 1/8 of the two other vertices, whose sum is the negative of the ends:
    // 1/4 of the sum of the ends.
    EXPECT_EQ(boundary_edges(fine), 0U);
    std::size_t found = 0;
    for (std::size_t v = 4; v < 10; ++v) {
        for (int a = 0; a < 4; ++a) {
            for (int b = 0; b < a; ++b) {
                const glm::vec3 middle =
                    (tetrahedron.positions[a] + tetrahedron.positions[b]) * 0.25F;
                found += glm::length(fine.positions[v] - middle) < subdivide_rounding ? 1 : 0;
            }
        }
    }
    EXPECT_EQ(found, 6U);
    EXPECT_TRUE(report.empty());
}

TEST(Subdivide, KeepsPlanesAndTheirTexture) {
    const Mesh grid = test::grid(8);
    Report report;
    const Mesh fine = subdivided(grid, 2, {}, report);
    EXPECT_EQ(fine.triangles.size(), 16 * grid.triangles.size());
    for (std::size_t v = 0; v < fine.positions.size(); ++v) {
        const glm::vec3& p = fine.positions[v];
        EXPECT_EQ(p.z, 0.0F);
        // Only the corners are rounded.
        const bool is_near_a_corner =
            std::min(p.x, 1 - p.x) < 0.3F && std::min(p.y, 1 - p.y) < 0.3F;
        if (is_near_a_corner) continue;
        EXPECT_NEAR(p.x, fine.texcoords[v].x, 1e-6);
        EXPECT_NEAR(p.y, 1.0F - fine.texcoords[v].y, 1e-6);
    }
}

TEST(Subdivide, ConvergesToItsLimitSurfaceByAQuarterALevel) {
    // Positions of the first vertices approach the limit surface. Each step is about a quarter of
    // the previous one, because the square of the subdominant eigenvalue at valence 6 is 1/4.
    const Mesh sphere = test::sphere(16, 8);
    Report report;
    std::vector<Mesh> levels;
    for (int level = 1; level <= 5; ++level)
        levels.push_back(subdivided(sphere, level, {}, report));
    double before = 0.0;
    for (std::size_t level = 1; level < levels.size(); ++level) {
        double step = 0.0;
        for (std::size_t v = 0; v < sphere.positions.size(); ++v) {
            step = std::max(step, double(glm::length(levels[level].positions[v] -
                                                     levels[level - 1].positions[v])));
        }
        if (level > 1) {
            EXPECT_LT(step, before * 0.45);
            EXPECT_GT(step, before * 0.15);
        }
        before = step;
    }
}

TEST(Subdivide, AFinerSphereIsNearerToTheSphereByTheSecondOrder) {
    // Loop's surface of a net on the unit sphere lies inside it at a distance proportional to the
    // square of the width of the net.
    std::vector<double> errors;
    for (const int slices : {12, 24, 48}) {
        Report report;
        const Mesh fine = subdivided(test::sphere(slices, slices / 2), 2, {}, report);
        double most = 0.0;
        for (const glm::vec3& p : fine.positions) {
            if (std::abs(p.y) > 0.7F) continue;  // Poles have one neighbor for each slice.
            most = std::max(most, std::abs(1.0 - glm::length(glm::dvec3(p))));
        }
        errors.push_back(most);
    }
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2.0, 0.3);
    EXPECT_NEAR(std::log2(errors[1] / errors[2]), 2.0, 0.2);
}

TEST(Subdivide, SeamsAreSmoothInSpaceAndExactInTexture) {
    const Mesh sphere = test::sphere(24, 12);
    Report report;
    const Mesh fine = subdivided(sphere, 1, {.normals = NormalWeight::angle}, report);
    EXPECT_EQ(boundary_edges(fine), 0U) << "not torn";
    // The texture of every triangle is a quarter of that of its parent.
    for (std::size_t t = 0; t < fine.triangles.size(); ++t) {
        glm::vec2 low(2.0F);
        glm::vec2 high(-2.0F);
        for (int i = 0; i < 3; ++i) {
            low = glm::min(low, fine.texcoords[fine.triangles[t][i]]);
            high = glm::max(high, fine.texcoords[fine.triangles[t][i]]);
        }
        EXPECT_NEAR(high.x - low.x, 0.5 / 24, 0.5 / 24 + 1e-6) << "smeared across the seam";
        EXPECT_NEAR(high.y - low.y, 0.5 / 12, 1e-6);
    }
    // At the seam, the normal is that of the sphere.
    for (std::size_t v = 0; v < fine.positions.size(); ++v) {
        if (std::abs(fine.positions[v].y) > 0.8F) continue;
        EXPECT_LT(test::degrees_between(fine.normals[v], fine.positions[v]), 1.5);
    }
}

// A walk around the hub for each spoke would take minutes.
TEST(Subdivide, AHubOfManySpokesIsLinear) {
    constexpr unsigned spokes = 100'000;
    Mesh hub;
    hub.positions.emplace_back(0.0F, 1.0F, 0.0F);
    for (unsigned i = 0; i < spokes; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / spokes;
        hub.positions.emplace_back(std::cos(angle), 0.0, std::sin(angle));
        hub.triangles.emplace_back(0, 1 + (i + 1) % spokes, 1 + i);
    }
    Report report;
    const Mesh fine = subdivided(hub, 1, {}, report);
    // alpha = (40 - (3 + 2 cos(2 pi / n))^2) / 64 with n neighbors at height 0 around the axis.
    const double turn = 3.0 + 2.0 * std::cos(2.0 * std::numbers::pi / spokes);
    EXPECT_NEAR(fine.positions[0].y, 1.0 - (40.0 - turn * turn) / 64.0, subdivide_rounding);
    EXPECT_NEAR(fine.positions[0].x, 0.0, subdivide_rounding);
}

TEST(Subdivide, SheetsThatMeetInAnEdgeStayTogether) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 0.2F, 0}, {0.3F, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
    Report report;
    const Mesh fine = subdivided(mesh, 2, {}, report);
    EXPECT_EQ(fine.triangles.size(), 48U);
    EXPECT_EQ(report.count("non-manifold edge"), 1U);
    Report after;
    topology_of(fine, weld_positions(fine.positions), after);
    EXPECT_EQ(after.count("non-manifold edge"), 4U) << "all four quarters of the edge";
}

TEST(Subdivide, NonFiniteTrianglesStayAndCollapsedOnesGo) {
    Mesh grid = test::grid(2);
    const auto bad = static_cast<std::uint32_t>(grid.positions.size());
    grid.positions.emplace_back(std::numeric_limits<float>::infinity());
    grid.normals.emplace_back(0, 0, 1);
    grid.texcoords.emplace_back(0.0F);
    grid.tangents.clear();
    const auto whole = static_cast<std::uint32_t>(grid.triangles.size());
    grid.triangles.emplace_back(0, 1, bad);
    grid.triangles.emplace_back(2, 2, 3);
    grid.material_ranges = {{0, whole, 0U}, {whole, 2, 1U}};
    Report report;
    const Mesh fine = subdivided(grid, 2, {}, report);
    EXPECT_EQ(fine.triangles.size(), 16U * whole + 1);
    EXPECT_EQ(fine.triangles.back(), glm::uvec3(0, 1, bad));
    ASSERT_EQ(fine.material_ranges.size(), 2U);
    EXPECT_EQ(fine.material_ranges[0].triangle_count, 16 * whole);
    EXPECT_EQ(fine.material_ranges[1].triangle_count, 1U);
    EXPECT_EQ(report.count("triangle with a non-finite position"), 1U);
    EXPECT_EQ(report.count("collapsed triangle"), 1U);
}

TEST(Subdivide, InterpolatesColorsAndIsAccurateFarFromTheOrigin) {
    Mesh grid = test::grid(1);
    grid.tangents.clear();
    for (const glm::vec3& p : grid.positions)
        grid.colors.emplace_back(p.x, p.y, 0.0F, 1.0F);
    Report report;
    const Mesh near = subdivided(grid, 3, {}, report);
    for (std::size_t v = 0; v < near.positions.size(); ++v)
        EXPECT_EQ(near.colors[v].r, near.texcoords[v].x);
    Mesh moved = grid;
    for (glm::vec3& p : moved.positions)
        p += glm::vec3(0x1p20F, 0, 0);
    const Mesh far = subdivided(moved, 3, {}, report);
    EXPECT_EQ(far.triangles, near.triangles);
    for (std::size_t v = 0; v < far.positions.size(); ++v)
        EXPECT_NEAR(far.positions[v].x - 0x1p20F, near.positions[v].x, 0.0626) << "half an ulp";
}

TEST(Subdivide, SmoothingGroupsGoWithTheirTriangles) {
    Mesh sheet = test::grid(2);
    sheet.smoothing_groups = {1, 1, 1, 1, 0, 7, 7, 7};
    Report report;
    const Mesh fine = subdivided(sheet, 2, {}, report);
    ASSERT_EQ(fine.smoothing_groups.size(), 8U * 16U);
    for (std::size_t t = 0; t < fine.triangles.size(); ++t)
        EXPECT_EQ(fine.smoothing_groups[t], sheet.smoothing_groups[t / 16]) << t;
}

TEST(Subdivide, EmptyAndOneTriangle) {
    Report report;
    EXPECT_TRUE(subdivided({}, 3, {}, report).triangles.empty());
    Mesh one;
    one.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    one.triangles = {{0, 1, 2}};
    const Mesh fine = subdivided(one, 1, {}, report);
    EXPECT_EQ(fine.triangles.size(), 4U);
    // The rule of the boundary: 1/8, 6/8, 1/8.
    EXPECT_LT(glm::length(fine.positions[0] - glm::vec3(0.125F, 0.125F, 0.0F)), subdivide_rounding);
    EXPECT_TRUE(report.empty());
}

TEST(Subdivide, RefusesLevelsThatAreNoneOrTooMany) {
    Report report;
    const auto refusal = [&](int levels) {
        return message_of<InvalidInput>([&] { subdivided(test::grid(1), levels, {}, report); });
    };
    EXPECT_EQ(refusal(0), "the number of levels is 0, but must be at least 1");
    EXPECT_EQ(refusal(20),
              "2 triangles make 2147483648 after 15 levels, but the limit is 1431655765");
}

Topology topology(const Mesh& mesh, Report& report) {
    return topology_of(mesh, weld_positions(mesh.positions), report);
}

std::size_t open_corners(const Topology& topology) {
    std::size_t count = 0;
    for (const Corner beyond : topology.opposite)
        count += beyond == no_corner ? 1 : 0;
    return count;
}

/// Opposite half-edges are mutual and run backwards. No two edges join the same vertices. The
/// corners of a vertex form one fan.
void expect_manifold(const Topology& topology) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::set<Corner>> edges;
    std::map<std::uint32_t, std::size_t> corners;
    std::map<std::uint32_t, std::size_t> joints;
    for (Corner c = 0; c < topology.opposite.size(); ++c) {
        const std::uint32_t from = vertex_of(c, topology.triangles);
        const std::uint32_t to = vertex_of(next_in_triangle(c), topology.triangles);
        ++corners[from];
        const Corner beyond = topology.opposite[c];
        edges[std::minmax(from, to)].insert(beyond == no_corner ? c : std::min(c, beyond));
        if (beyond == no_corner) continue;
        ++joints[from];
        ASSERT_EQ(topology.opposite[beyond], c);
        EXPECT_EQ(vertex_of(beyond, topology.triangles), to);
        EXPECT_EQ(vertex_of(next_in_triangle(beyond), topology.triangles), from);
    }
    for (const auto& [ends, corners_there] : edges)
        EXPECT_EQ(corners_there.size(), 1U) << ends.first << " " << ends.second;
    // A fan of n corners has n - 1 joints, or n if it is closed. Joints are counted at the
    // beginning of an edge, and each inner edge has two.
    for (const auto& [vertex, count] : corners) {
        EXPECT_GE(joints[vertex] + 1, count) << "vertex " << vertex;
        EXPECT_LE(joints[vertex], count);
    }
}

TEST(Topology, WeldsASeamAndClosesASphere) {
    const Mesh sphere = test::sphere(12, 6);
    Report report;
    const Topology surface = topology(sphere, report);
    EXPECT_EQ(open_corners(surface), 0U);
    // Euler's formula: V - E + F = 2.
    EXPECT_EQ(surface.position_vertex.size(),
              3 * surface.triangles.size() / 2 - surface.triangles.size() + 2);
    expect_manifold(surface);
}

TEST(Topology, LeavesOutCollapsedTrianglesAndSetsNonFiniteOnesAside) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Mesh mesh = mesh_from({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {nan, 0, 0}},
                                {{0, 1, 2}, {1, 3, 2}, {2, 2, 0}, {0, 4, 1}});
    Report report;
    const Topology surface = topology(mesh, report);
    EXPECT_EQ(surface.source_triangle, std::vector<std::uint32_t>{0});
    EXPECT_EQ(surface.set_aside, std::vector<std::uint32_t>{3});
    EXPECT_EQ(report.count("collapsed triangle"), 2U);
    EXPECT_EQ(report.count("triangle with a non-finite position"), 1U);
}

TEST(Topology, CutsThreeSheetsAtTheirEdgeApart) {
    const Mesh mesh = mesh_from({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}},
                                {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
    Report report;
    const Topology surface = topology(mesh, report);
    EXPECT_EQ(report.count("non-manifold edge"), 1U);
    EXPECT_EQ(surface.position_vertex.size(), 9U) << "each triangle by itself";
    EXPECT_EQ(open_corners(surface), 9U);
    for (std::size_t v = 0; v < 9; ++v)
        EXPECT_EQ(surface.is_cut[v], surface.position_vertex[v] < 2);
    expect_manifold(surface);
}

TEST(Topology, SeparatesNeighborsThatFaceOppositeWays) {
    Report report;
    const Topology surface = topology(
        mesh_from({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 2, 3}}), report);
    // Both triangles run from vertex 1 to 2.
    EXPECT_EQ(report.count("non-manifold edge"), 1U);
    EXPECT_EQ(open_corners(surface), 6U);
}

TEST(Topology, CutsABowTieAtItsVertex) {
    Report report;
    const Topology surface =
        topology(mesh_from({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}},
                           {{0, 1, 2}, {0, 3, 4}}),
                 report);
    EXPECT_TRUE(report.empty()) << "no edge is at fault";
    EXPECT_EQ(surface.position_vertex.size(), 6U);
    EXPECT_EQ(std::count(surface.is_cut.begin(), surface.is_cut.end(), true), 2);
}

TEST(Topology, AnySoupBecomesAManifold) {
    std::mt19937 source(5);
    const auto random = [&] { return static_cast<unsigned>(source()); };
    for (int round = 0; round < 200; ++round) {
        Mesh mesh;
        const unsigned vertices = 4 + random() % 6;
        for (unsigned v = 0; v < vertices; ++v)
            mesh.positions.emplace_back(v, v * v, v % 3);
        const unsigned triangles = 1 + random() % 40;
        for (unsigned t = 0; t < triangles; ++t)
            mesh.triangles.emplace_back(random() % vertices, random() % vertices,
                                        random() % vertices);
        Report report;
        expect_manifold(topology(mesh, report));
        if (HasFailure()) FAIL() << "round " << round;
    }
}

TEST(Topology, EmptyIsEmpty) {
    Report report;
    EXPECT_TRUE(topology({}, report).triangles.empty());
    EXPECT_TRUE(report.empty());
}

}  // namespace
}  // namespace relief
