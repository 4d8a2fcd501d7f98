// SPDX-License-Identifier: Apache-2.0
// Repair of meshes with known faults.
#include "relief/mesh/repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "relief/mesh/diagnose.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "support/hard_meshes.h"
#include "support/manifold.h"
#include "support/shapes.h"

namespace relief {
namespace {

using test::manifold_faults;
using testing::ElementsAre;

Mesh positions_only(Mesh mesh) {
    Mesh result;
    result.positions = std::move(mesh.positions);
    result.triangles = std::move(mesh.triangles);
    return result;
}

Mesh joined_meshes(const Mesh& a, const Mesh& b) {
    Mesh result = a;
    const auto first = static_cast<std::uint32_t>(a.positions.size());
    result.positions.insert(result.positions.end(), b.positions.begin(), b.positions.end());
    for (const glm::uvec3& triangle : b.triangles)
        result.triangles.push_back(triangle + first);
    return result;
}

Mesh cube_at(const glm::vec3& center, float size = 1.0F) {
    Mesh mesh = positions_only(test::uneven_cube());
    for (glm::vec3& p : mesh.positions)
        p = center + size * p;
    return mesh;
}

void reverse(Mesh& mesh, std::size_t from = 0) {
    for (std::size_t t = from; t < mesh.triangles.size(); ++t)
        std::swap(mesh.triangles[t].y, mesh.triangles[t].z);
}

double signed_volume(const Mesh& mesh) {
    double volume = 0.0;
    for (const glm::uvec3& t : mesh.triangles)
        volume +=
            glm::dot(glm::dvec3(mesh.positions[t.x]),
                     glm::cross(glm::dvec3(mesh.positions[t.y]), glm::dvec3(mesh.positions[t.z]))) /
            6.0;
    return volume;
}

TEST(Repair, DoesNotChangeASoundMesh) {
    const Mesh mesh = make_cube();
    Report report;
    const FramedMesh result = repaired(mesh, {}, report);
    EXPECT_TRUE(report.empty());
    EXPECT_EQ(result.mesh.positions, mesh.positions);
    EXPECT_EQ(result.mesh.normals, mesh.normals);
    EXPECT_EQ(result.mesh.texcoords, mesh.texcoords);
    EXPECT_EQ(result.mesh.triangles, mesh.triangles);
}

TEST(Repair, MergesEqualVerticesAndKeepsSeams) {
    Mesh mesh = positions_only(test::square());
    // Two triangles with vertices of their own.
    Mesh split;
    for (const glm::uvec3& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k)
            split.positions.push_back(mesh.positions[t[k]]);
    }
    split.triangles = {{0, 1, 2}, {3, 4, 5}};
    Report report;
    EXPECT_EQ(repaired(split, {}, report).mesh.positions.size(), 4U);
    EXPECT_EQ(report.count("equal vertex"), 2U);
    EXPECT_EQ(repaired(split, {.merge_vertices = false}).mesh.positions.size(), 6U);
    split.texcoords = {{0, 0}, {1, 0}, {1, 1}, {2, 0}, {2, 1}, {3, 1}};
    EXPECT_EQ(repaired(split).mesh.positions.size(), 6U);
    Deformation deformation;
    split.texcoords.clear();
    deformation.joints = {{1, 0, 0, 0}, {1, 0, 0, 0}, {1, 0, 0, 0},
                          {0, 1, 0, 0}, {0, 1, 0, 0}, {0, 1, 0, 0}};
    EXPECT_EQ(repaired(split, {}, report, deformation).mesh.positions.size(), 6U);
}

TEST(Repair, WeldsWithinTheTolerance) {
    const Mesh mesh = positions_only(test::ramp(1.0F, 1.001F));
    EXPECT_EQ(manifold_faults(repaired(mesh).mesh).boundary_edges, 8U);
    Report report;
    const Mesh welded = repaired(mesh, {.weld_tolerance = 0.01}, report).mesh;
    EXPECT_EQ(manifold_faults(welded).boundary_edges, 6U);
    EXPECT_EQ(report.count("vertex near another one"), 2U);
    EXPECT_EQ(welded.positions.size(), 6U);
}

TEST(Repair, RemovesCollapsedRepeatedAndNonFiniteTriangles) {
    Mesh mesh = positions_only(test::square());
    mesh.positions.emplace_back(test::not_a_number, 0.0F, 0.0F);
    mesh.triangles.insert(mesh.triangles.end(), {{0, 1, 1}, {0, 1, 4}, mesh.triangles[0]});
    Report report;
    const FramedMesh result = repaired(mesh, {}, report);
    EXPECT_EQ(result.mesh.triangles.size(), 2U);
    EXPECT_EQ(result.mesh.positions.size(), 4U);
    EXPECT_EQ(report.count("collapsed triangle"), 1U);
    EXPECT_EQ(report.count("triangle with a non-finite corner"), 1U);
    EXPECT_EQ(report.count("repeated triangle"), 1U);
    Report kept_report;
    const FramedMesh kept = repaired(mesh,
                                     {.remove_non_finite = false,
                                      .remove_collapsed = false,
                                      .remove_duplicates = false,
                                      .orient = false,
                                      .separate = false},
                                     kept_report);
    EXPECT_EQ(kept.mesh.triangles.size(), 5U);
    EXPECT_TRUE(kept_report.empty());
}

TEST(Repair, TreatsTwoSidedTrianglesAsRequested) {
    Mesh mesh = positions_only(test::wavy_grid(4));
    Mesh back = mesh;
    reverse(back);
    const Mesh both = joined_meshes(mesh, back);
    Report report;
    const Mesh kept = repaired(both, {}, report).mesh;
    EXPECT_EQ(kept.triangles.size(), 64U);
    EXPECT_TRUE(manifold_faults(kept).is_manifold());
    EXPECT_EQ(report.count("two-sided triangle"), 0U);
    const Mesh single = repaired(both, {.two_sided = TwoSided::single}, report).mesh;
    EXPECT_EQ(single.triangles.size(), 32U);
    EXPECT_TRUE(manifold_faults(single).is_manifold());
    EXPECT_EQ(manifold_faults(single).boundary_edges, 16U);
    EXPECT_EQ(report.count("two-sided triangle"), 32U);
    EXPECT_TRUE(repaired(both, {.two_sided = TwoSided::remove}).mesh.triangles.empty());
}

/// The number of triangles of which the other side has the same positions.
std::size_t two_sided_triangles(const Mesh& mesh) {
    return diagnose(mesh).count(MeshCondition::triangle_two_sided);
}

TEST(Repair, KeepsTheSidesOfWallsTogether) {
    // Three doubled walls that meet in one line, and a cube of which one side is doubled.
    Mesh walls;
    walls.positions = {{0, 0, 0},  {0, 0, 1},  {1, 0, 0},   {1, 0, 1},
                       {-1, 1, 0}, {-1, 1, 1}, {-1, -1, 0}, {-1, -1, 1}};
    for (const std::uint32_t end : {2U, 4U, 6U}) {
        walls.triangles.emplace_back(0U, 1U, end);
        walls.triangles.emplace_back(end, 1U, end + 1);
    }
    Mesh back = walls;
    reverse(back);
    Mesh mesh = joined_meshes(joined_meshes(walls, back), cube_at({5, 0, 0}));
    const glm::uvec3 side = mesh.triangles.back();
    mesh.triangles.emplace_back(side.y, side.x, side.z);
    ASSERT_EQ(two_sided_triangles(mesh), 14U);
    EXPECT_LT(two_sided_triangles(repaired(mesh).mesh), 14U);
    Report report;
    const Mesh once = repaired(mesh, {.two_sided = TwoSided::together}, report).mesh;
    EXPECT_EQ(once.triangles.size(), mesh.triangles.size());
    EXPECT_EQ(two_sided_triangles(once), 14U);
    EXPECT_EQ(report.count("triangle with the wrong winding"), 0U);
    EXPECT_EQ(report.count("non-manifold edge"), 1U) << "only that of the three walls";
    // The fronts are a manifold, and a second repair changes nothing.
    EXPECT_TRUE(
        manifold_faults(repaired(once, {.two_sided = TwoSided::single}).mesh).is_manifold());
    Report again;
    EXPECT_EQ(repaired(once, {.two_sided = TwoSided::together}, again).mesh.positions,
              once.positions);
    EXPECT_EQ(again.count("non-manifold edge"), 0U);
    EXPECT_EQ(again.count("triangles that meet others only at a position"), 0U);
    // Sides in any winding are fronts: no edge inside of a wall is cut.
    const Mesh kept = repaired(once).mesh;
    EXPECT_TRUE(manifold_faults(kept).is_manifold());
    EXPECT_THROW(repaired(mesh, {.two_sided = TwoSided::together, .orient = false}), InvalidInput);
}

TEST(Repair, OrientsClosedPartsOutwards) {
    Mesh mesh = cube_at({0, 0, 0});
    std::swap(mesh.triangles[3].x, mesh.triangles[3].y);
    Report report;
    Mesh result = repaired(mesh, {}, report).mesh;
    EXPECT_EQ(report.count("triangle with the wrong winding"), 1U);
    EXPECT_TRUE(manifold_faults(result).is_watertight());
    EXPECT_DOUBLE_EQ(signed_volume(result), 8.0);
    reverse(mesh);
    EXPECT_DOUBLE_EQ(signed_volume(repaired(mesh).mesh), 8.0);
    EXPECT_DOUBLE_EQ(signed_volume(repaired(mesh, {.orient = false, .separate = false}).mesh),
                     signed_volume(mesh));
}

TEST(Repair, KeepsTheWallsOfCavities) {
    Mesh cavity = cube_at({0.1F, 0.2F, 0.05F}, 0.5F);
    reverse(cavity);
    const Mesh hollow = joined_meshes(cube_at({0, 0, 0}), cavity);
    EXPECT_DOUBLE_EQ(signed_volume(repaired(hollow).mesh), signed_volume(hollow));
    // A part in the cavity is a solid again.
    const Mesh filled = joined_meshes(hollow, cube_at({0, 0, 0}, 0.25F));
    EXPECT_DOUBLE_EQ(signed_volume(repaired(filled).mesh), signed_volume(filled));
    // A reversed cube beside the other one is none.
    Mesh beside = cube_at({3, 0, 0}, 0.5F);
    reverse(beside);
    EXPECT_DOUBLE_EQ(signed_volume(repaired(joined_meshes(cube_at({0, 0, 0}), beside)).mesh), 9.0);
}

TEST(Repair, OpenPartsKeepTheWindingOfMostOfTheirArea) {
    Mesh mesh = positions_only(test::flat_grid(4));
    for (std::size_t t = 0; t < 12; ++t)
        std::swap(mesh.triangles[t].y, mesh.triangles[t].z);
    Report report;
    const Mesh result = repaired(mesh, {}, report).mesh;
    EXPECT_EQ(report.count("triangle with the wrong winding"), 12U);
    EXPECT_TRUE(manifold_faults(result).is_manifold());
    EXPECT_EQ(result.triangles, positions_only(test::flat_grid(4)).triangles);
}

TEST(Repair, NegatesTheNormalsOfReversedTriangles) {
    Mesh mesh = make_sphere(16, 8);
    for (glm::vec3& normal : mesh.normals)
        normal = -normal;
    mesh.tangents.assign(mesh.positions.size(), {1, 0, 0, 1});
    reverse(mesh);
    Report report;
    const Mesh result = repaired(mesh, {}, report).mesh;
    ASSERT_FALSE(result.normals.empty());
    for (std::size_t v = 0; v < result.normals.size(); ++v) {
        EXPECT_GT(glm::dot(result.normals[v], result.positions[v]), 0.9F);
        EXPECT_EQ(result.tangents[v].w, -1.0F);
    }
    EXPECT_GT(report.count("normal at the back of a reversed triangle"), 0U);
}

TEST(Repair, SeparatesCubesThatShareAnEdge) {
    const Mesh mesh = joined_meshes(cube_at({0, 0, 0}), cube_at({2, 2, 0}));
    EXPECT_GT(manifold_faults(mesh).crowded_edges, 0U);
    Report report;
    const FramedMesh result = repaired(mesh, {}, report);
    EXPECT_TRUE(manifold_faults(result.mesh).is_watertight());
    EXPECT_EQ(report.count("non-manifold edge"), 1U);
    EXPECT_NEAR(signed_volume(result.mesh), 16.0, 1e-4);
    for (std::size_t v = 0; v < result.mesh.positions.size(); ++v)
        EXPECT_LT(glm::length(result.mesh.positions[v] - mesh.positions[result.source_vertex[v]]),
                  9.0 / 1048576.0);
    EXPECT_GT(manifold_faults(repaired(mesh, {.separate = false}).mesh).crowded_edges, 0U);
}

TEST(Repair, KeepsTheFlattestPairAtAFin) {
    // A flat square with a fin on its diagonal.
    Mesh mesh = positions_only(test::square());
    mesh.positions.emplace_back(0.5F, 0.5F, 1.0F);
    mesh.triangles.emplace_back(0, 2, 4);
    const Mesh result = repaired(mesh).mesh;
    EXPECT_TRUE(manifold_faults(result).is_manifold());
    EXPECT_EQ(manifold_faults(result).boundary_edges, 7U);
    ASSERT_EQ(result.triangles.size(), 3U);
    EXPECT_EQ(result.triangles[0], mesh.triangles[0]);
    EXPECT_EQ(result.triangles[1], mesh.triangles[1]);
}

TEST(Repair, CutsAMoebiusStripOnce) {
    Mesh mesh;
    constexpr std::uint32_t count = 24;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / count;
        for (const double side : {-0.3, 0.3}) {
            const double radius = 1.0 + side * std::cos(angle / 2.0);
            mesh.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                                        side * std::sin(angle / 2.0));
        }
        const std::uint32_t a = 2 * i;
        const std::uint32_t next = (2 * i + 2) % (2 * count);
        const std::uint32_t turn = i + 1 == count ? 1 : 0;
        mesh.triangles.emplace_back(a, a + 1, next + turn);
        mesh.triangles.emplace_back(a + 1, next + 1 - turn, next + turn);
    }
    Report report;
    const Mesh result = repaired(mesh, {}, report).mesh;
    EXPECT_TRUE(manifold_faults(result).is_manifold());
    EXPECT_EQ(result.triangles.size(), 2 * count);
    EXPECT_EQ(report.count("edge of a part that has no consistent winding"), 1U);
    EXPECT_EQ(manifold_faults(result).boundary_edges, 2 * count + 2);
}

TEST(Repair, SeparatesASurfaceThatTouchesItselfAlongAnEdge) {
    // Layers of cubes above and below the two that share an edge make one fan of both cubes at each
    // end of the edge.
    Mesh mesh = joined_meshes(cube_at({0, 0, 0}), cube_at({2, 2, 0}));
    mesh = joined_meshes(mesh, cube_at({0, 2, 2}));
    mesh = joined_meshes(mesh, cube_at({2, 0, 2}));
    mesh = joined_meshes(mesh, cube_at({0, 0, 2}));
    mesh = joined_meshes(mesh, cube_at({2, 2, 2}));
    mesh = joined_meshes(mesh, cube_at({0, 2, -2}));
    mesh = joined_meshes(mesh, cube_at({2, 0, -2}));
    mesh = joined_meshes(mesh, cube_at({0, 0, -2}));
    mesh = joined_meshes(mesh, cube_at({2, 2, -2}));
    Report report;
    const Mesh result = repaired(mesh, {.two_sided = TwoSided::remove}, report).mesh;
    EXPECT_TRUE(manifold_faults(result).is_manifold());
}

TEST(Repair, DropsSmallParts) {
    const Mesh mesh = joined_meshes(cube_at({0, 0, 0}), cube_at({5, 0, 0}, 0.01F));
    Report report;
    EXPECT_EQ(repaired(mesh, {.drop_parts = 0.1}, report).mesh.triangles.size(), 12U);
    EXPECT_EQ(report.count("triangle of a small part"), 12U);
    EXPECT_EQ(repaired(mesh, {.drop_parts = 100.0}).mesh.triangles.size(), 12U);
    EXPECT_EQ(repaired(mesh, {.drop_parts = 0.01}).mesh.triangles.size(), 24U);
}

TEST(Repair, KeepsMaterialRangesAndSmoothingGroups) {
    Mesh mesh = positions_only(test::flat_grid(2));
    mesh.material_ranges = {{0, 3, 7}, {3, 1, std::nullopt}, {4, 4, 2}};
    mesh.smoothing_groups = {1, 2, 3, 4, 5, 6, 7, 8};
    mesh.triangles[3] = glm::uvec3(0, 0, 1);
    const Mesh result = repaired(mesh).mesh;
    EXPECT_THAT(result.material_ranges,
                ElementsAre(MaterialRange{0, 3, 7}, MaterialRange{3, 0, std::nullopt},
                            MaterialRange{3, 4, 2}));
    EXPECT_THAT(result.smoothing_groups, ElementsAre(1, 2, 3, 5, 6, 7, 8));
    EXPECT_NO_THROW(validate(result));
}

TEST(Repair, RefusesLengthsOutOfRange) {
    const Mesh mesh = make_cube();
    EXPECT_THROW(repaired(mesh, {.weld_tolerance = -1.0}), InvalidInput);
    EXPECT_THROW(repaired(mesh, {.drop_parts = std::nan("")}), InvalidInput);
}

TEST(Repair, AnEmptyMeshStaysEmpty) {
    EXPECT_TRUE(repaired({}).mesh.triangles.empty());
}

}  // namespace
}  // namespace relief
