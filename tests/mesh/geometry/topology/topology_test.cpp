// SPDX-License-Identifier: Apache-2.0
// The surface that a mesh is: neighbors, cuts, and what takes no part. Whatever the triangles, the
// outcome is a manifold: every edge has at most two triangles, every vertex one fan.
#include "topology/topology.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <random>
#include <set>

#include "geometry/weld.h"
#include "support/shapes.h"

namespace relief {
namespace {

using test::mesh_from;

Topology topology(const Mesh& mesh, Report& report) {
    return topology_of(mesh, weld_positions(mesh.positions), report);
}

std::size_t open_corners(const Topology& topology) {
    std::size_t count = 0;
    for (const Corner beyond : topology.opposite)
        count += beyond == no_corner ? 1 : 0;
    return count;
}

/// Opposites are mutual and run backwards; no two edges join the same vertices; the corners of a
/// vertex are one fan.
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
    // A fan of n corners is joined at n - 1 places, or at n all around. Joints are counted at the
    // edge's beginning, which each inner edge has at both its ends.
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
    // Euler: V - E + F = 2.
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

TEST(Topology, CutsNeighboursThatFaceOppositeWaysApart) {
    Report report;
    const Topology surface = topology(
        mesh_from({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 2, 3}}), report);
    // Both run from vertex 1 to 2.
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
