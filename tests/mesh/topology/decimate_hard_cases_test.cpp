// SPDX-License-Identifier: Apache-2.0
// Decimation of hard meshes: each ends after a number of steps that is proportional to its
// triangles.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "geometry/weld.h"
#include "mesh/topology/boundary_edges.h"
#include "mesh/topology/decimated_to.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/topology.h"
#include "support/shapes.h"
#include "topology/edge_collapse.h"
#include "topology/topology.h"

namespace relief {
using namespace relief::detail;

namespace {

using test::boundary_edges;
using test::decimated_to;

/// Returns a fan of triangles around the first vertex: the cap of a cylinder.
Mesh fan(std::uint32_t triangles) {
    Mesh mesh;
    mesh.positions.emplace_back(0.0F);
    for (std::uint32_t i = 0; i < triangles; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / triangles;
        mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0.0);
        mesh.triangles.emplace_back(0, 1 + i, 1 + (i + 1) % triangles);
    }
    return mesh;
}

/// Decimates the welded surface of a mesh without attributes, and checks the number of triangles
/// that were examined.
Collapsed collapsed(const Mesh& mesh, std::size_t triangles) {
    const std::vector<std::uint32_t> classes = weld_positions(mesh.positions);
    Report report;
    CollapseInput input;
    input.topology = topology_of(mesh, classes, report);
    for (const std::uint32_t vertex : input.topology.position_vertex)
        input.positions.push_back(mesh.positions[vertex]);
    for (const std::uint32_t t : input.topology.source_triangle) {
        const glm::uvec3& triangle = mesh.triangles[t];
        input.wedges.emplace_back(classes[triangle.x], classes[triangle.y], classes[triangle.z]);
    }
    input.wedge_count = mesh.positions.size();
    input.triangles = triangles;
    Collapsed result = collapse_edges(std::move(input));
    EXPECT_LE(result.examined, 40 * mesh.triangles.size() + 1000);
    return result;
}

TEST(DecimateHardCases, FansEndInLinearTimeWithFewTriangles) {
    for (const std::uint32_t count : {300U, 5000U, 40000U}) {
        const Collapsed result = collapsed(fan(count), 12);
        EXPECT_LE(result.triangles, 12U) << count;
        EXPECT_GE(result.triangles, 11U) << count;
    }
}

TEST(DecimateHardCases, TwoFansThatShareTheirRimKeepTheirTopology) {
    // A bipyramid: each vertex of the rim is next to both apexes, which have 20000 triangles.
    Mesh mesh = fan(20000);
    const auto apex = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions[0].z = 1.0F;
    mesh.positions.emplace_back(0.0F, 0.0F, -1.0F);
    for (std::uint32_t i = 0; i < 20000; ++i) {
        const glm::uvec3 t = mesh.triangles[i];
        mesh.triangles.emplace_back(apex, t.z, t.y);
    }
    EXPECT_LE(collapsed(mesh, 40).triangles, 40U);
    Report report;
    const Mesh small = decimated_to(mesh, 40, report);
    EXPECT_EQ(boundary_edges(small), 0U);
    // Euler's formula for a sphere.
    EXPECT_EQ(small.triangles.size(), 2 * (small.positions.size() - 2));
}

TEST(DecimateHardCases, ASphereWithPolesOfHighValenceIsDecimatedLikeAnyOther) {
    const Collapsed result = collapsed(make_sphere(1000, 20), 500);
    EXPECT_LE(result.triangles, 500U);
    EXPECT_GE(result.triangles, 499U);
}

TEST(DecimateHardCases, ABookKeepsItsTriangles) {
    // Pages that share an edge: it is not manifold, so its ends do not move, and no page may
    // vanish.
    Mesh book;
    book.positions = {{0, 0, 0}, {0, 0, 1}};
    for (std::uint32_t i = 0; i < 5000; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 5000.0;
        book.positions.emplace_back(std::cos(angle), std::sin(angle), 0.5);
        book.triangles.emplace_back(0, 1, i + 2);
    }
    EXPECT_EQ(collapsed(book, 1).triangles, 5000U);
    Report report;
    EXPECT_EQ(decimated_to(book, 1, report).triangles.size(), 5000U);
    EXPECT_EQ(report.count("non-manifold edge"), 1U);
    EXPECT_EQ(report.count("number of triangles out of reach"), 1U);
}

TEST(DecimateHardCases, SingleTrianglesAreKept) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> coordinate(-1.0F, 1.0F);
    Mesh soup;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        for (int k = 0; k < 3; ++k)
            soup.positions.emplace_back(coordinate(random), coordinate(random), coordinate(random));
        soup.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    EXPECT_EQ(collapsed(soup, 1).triangles, 3000U) << "components do not vanish";
}

TEST(DecimateHardCases, BowTiesKeepTheirCommonVertex) {
    // Two grids that touch at a corner.
    Mesh mesh = test::grid(10);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const std::size_t triangles = mesh.triangles.size();
    for (std::uint32_t v = 0; v < first; ++v)
        mesh.positions.push_back(mesh.positions[v] + glm::vec3(1.0F, 1.0F, 0.0F));
    for (std::size_t t = 0; t < triangles; ++t)
        mesh.triangles.push_back(mesh.triangles[t] + first);
    mesh.normals.clear();
    mesh.texcoords.clear();
    mesh.tangents.clear();
    mesh.material_ranges.clear();
    collapsed(mesh, 4);
    Report report;
    const Mesh small = decimated_to(mesh, 4, report);
    EXPECT_EQ(small.triangles.size(), 4U);
    EXPECT_EQ(std::count(small.positions.begin(), small.positions.end(), glm::vec3(1, 1, 0)), 1);
}

TEST(DecimateHardCases, RepeatedTrianglesCountOnce) {
    Mesh mesh = make_torus(0.4F, 12, 8);
    mesh.material_ranges.clear();
    Report report;
    const Mesh expected = decimated_to(mesh, 120, report, NormalWeight::angle);
    EXPECT_EQ(report.count("repeated triangle"), 0U);
    const std::vector<glm::uvec3> triangles = mesh.triangles;
    mesh.triangles.insert(mesh.triangles.end(), triangles.begin(), triangles.end());
    const Mesh small = decimated_to(mesh, 120, report, NormalWeight::angle);
    EXPECT_EQ(small.positions, expected.positions);
    EXPECT_EQ(small.triangles, expected.triangles);
    EXPECT_EQ(report.count("repeated triangle"), triangles.size());
    EXPECT_EQ(report.count("non-manifold edge"), 0U);
    collapsed(mesh, 10);
}

TEST(DecimateHardCases, TrianglesWithoutAreaAreRemovedFirst) {
    // All vertices of a row are on one line, so half of the triangles have no area.
    Mesh strip;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        strip.positions.emplace_back(static_cast<float>(i), 0.0F, 0.0F);
        strip.positions.emplace_back(static_cast<float>(i) + 0.5F, 0.0F, 0.0F);
        if (i == 0) continue;
        strip.triangles.emplace_back(2 * i - 2, 2 * i - 1, 2 * i);
        strip.triangles.emplace_back(2 * i - 1, 2 * i + 1, 2 * i);
    }
    EXPECT_LE(collapsed(strip, 10).triangles, 10U);
}

TEST(DecimateHardCases, TinyComponentsKeepATriangleOrATetrahedron) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < 500; ++i) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        const glm::vec3 at(2.0F * static_cast<float>(i), 0.0F, 0.0F);
        for (const glm::vec3 corner :
             {glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1)})
            mesh.positions.push_back(corner + at);
        for (const glm::uvec3 t :
             {glm::uvec3(0, 2, 1), glm::uvec3(0, 1, 3), glm::uvec3(1, 2, 3), glm::uvec3(2, 0, 3)})
            mesh.triangles.push_back(t + first);
    }
    EXPECT_EQ(collapsed(mesh, 1).triangles, 2000U);
}

TEST(DecimateHardCases, ManyWedgesAtOnePosition) {
    // Each triangle of a fan has its own texture coordinate in the middle and at the rim.
    const Mesh welded = fan(20000);
    Mesh mesh;
    for (const glm::uvec3& t : welded.triangles) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        const float u = static_cast<float>(mesh.triangles.size()) / 20000.0F;
        for (int i = 0; i < 3; ++i) {
            mesh.positions.push_back(welded.positions[t[i]]);
            mesh.texcoords.emplace_back(u, static_cast<float>(i));
        }
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    Report report;
    EXPECT_EQ(decimated_to(mesh, 1, report).triangles.size(), 20000U) << "all edges are seams";
    EXPECT_EQ(report.count("number of triangles out of reach"), 1U);
}

}  // namespace
}  // namespace relief
