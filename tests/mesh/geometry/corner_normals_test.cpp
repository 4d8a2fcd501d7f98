// SPDX-License-Identifier: Apache-2.0
// Corner normals with hard edges, and hard edges inferred from stored normals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/trigonometric.hpp>
#include <map>
#include <numbers>

#include "mesh/geometry/normal_samples.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/report.h"
#include "support/hard_meshes.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/shapes.h"

namespace relief {
namespace {

using test::degrees_between;
using test::facing_up;

constexpr double degree = std::numbers::pi / 180.0;

CornerNormals corners_of(const Mesh& mesh, const HardEdges& hard_edges, Report& report,
                         std::optional<NormalWeight> weight = NormalWeight::angle) {
    return corner_normals(mesh.positions, mesh.triangles, weight, {}, hard_edges, report);
}

std::vector<glm::vec3> creased(const Mesh& mesh, double degrees) {
    Report report;
    return corners_of(mesh, {degrees * degree, {}}, report).normals;
}

/// Two squares of two triangles each that share the y axis. The right one is rotated up by
/// `degrees`.
Mesh folded_sheet(double degrees, double scale = 1.0) {
    const double c = scale * std::cos(degrees * degree);
    const double s = scale * std::sin(degrees * degree);
    Mesh mesh;
    mesh.positions = {{-scale, 0, 0},     {0, 0, 0},     {c, 0, s},
                      {-scale, scale, 0}, {0, scale, 0}, {c, scale, s}};
    mesh.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
    return mesh;
}

TEST(CornerNormals, ACubeIsFlatBelowItsEdgesAngleAndRoundFromThereOn) {
    Mesh cube = test::cube();
    const auto flat = creased(cube, 89.9);
    const auto round = creased(cube, 90.0);
    for (std::size_t c = 0; c < flat.size(); ++c) {
        const std::uint32_t vertex = cube.triangles[c / 3][static_cast<int>(c % 3)];
        EXPECT_EQ(flat[c], cube.normals[vertex]);
        EXPECT_LE(degrees_between(round[c], glm::dvec3(cube.positions[vertex])), 1e-5);
    }
}

TEST(CornerNormals, EdgeAtTheLimitIsSmoothDespiteRounding) {
    for (const double angle : {1.0, 15.0, 30.0, 45.0, 60.0, 89.0, 120.0, 179.0}) {
        for (const double scale : {1e-20, 0.37, 1.0, 1e20}) {
            const Mesh sheet = folded_sheet(angle, scale);
            const auto smooth = creased(sheet, angle);
            EXPECT_NE(smooth[1], facing_up) << angle << " at " << scale;
            EXPECT_EQ(smooth[1], smooth[6]) << angle << " at " << scale;
            const auto hard = creased(sheet, angle - 0.01);
            EXPECT_EQ(hard[1], facing_up) << angle << " at " << scale;
        }
    }
}

TEST(CornerNormals, TriangleThatOnlyTouchAreApart) {
    // A bow-tie: two perpendicular triangles that share one vertex.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, 0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 3, 4}};
    Report report;
    const auto normals = corners_of(mesh, {std::numbers::pi, {}}, report).normals;
    EXPECT_EQ(normals[0], facing_up);
    EXPECT_EQ(normals[3], glm::vec3(0, 1, 0));
    EXPECT_TRUE(report.empty());
    // Without hard edges, one vertex has one normal.
    const auto shared =
        vertex_normals(mesh.positions, mesh.triangles, NormalWeight::uniform, report);
    EXPECT_LE(degrees_between(shared[0], glm::dvec3(0, 1, 1)), 1e-5);
}

TEST(CornerNormals, AnEdgeOfThreeTrianglesJoinsThoseWithinTheAngle) {
    // Three triangles around the y axis, rotated by 0, 20 and 90 degrees from up.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 1, 0}};
    for (const double angle : {0.0, 20.0, 90.0}) {
        mesh.triangles.push_back({0, 1, static_cast<std::uint32_t>(mesh.positions.size())});
        mesh.positions.emplace_back(-std::cos(angle * degree), 0.5, -std::sin(angle * degree));
    }
    for (int turn = 0; turn < 3; ++turn) {
        const auto normals = creased(mesh, 30.0);
        std::map<std::uint32_t, glm::vec3> at;
        for (std::size_t t = 0; t < 3; ++t)
            at[mesh.triangles[t].z] = normals[3 * t];
        EXPECT_EQ(at[2], at[3]);
        EXPECT_NEAR(degrees_between(at[2], facing_up), 10.0, 1e-4);
        EXPECT_NEAR(degrees_between(at[4], facing_up), 90.0, 1e-4);
        std::rotate(mesh.triangles.begin(), mesh.triangles.begin() + 1, mesh.triangles.end());
    }
    // The angle between the second and the third one is 70 degrees, so all three share a normal.
    const auto all = creased(mesh, 71.0);
    EXPECT_EQ(all[0], all[3]);
    EXPECT_EQ(all[0], all[6]);
}

TEST(CornerNormals, OppositelyWoundNeighborsHaveAHardEdge) {
    Mesh sheet = folded_sheet(0.0);
    sheet.triangles[2] = {1, 5, 2};
    sheet.triangles[3] = {1, 4, 5};
    const auto normals = creased(sheet, 60.0);
    EXPECT_EQ(normals[0], facing_up);
    EXPECT_EQ(normals[6], -facing_up);
}

TEST(CornerNormals, ASliverWithoutAreaIsLookedThrough) {
    // A triangle without area lies along the common edge of the two squares of a sheet.
    for (const double angle : {20.0, 80.0}) {
        Mesh sheet = folded_sheet(angle);
        sheet.positions.emplace_back(0.0F, 0.5F, 0.0F);
        sheet.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 6}, {2, 5, 6}, {6, 5, 4}, {1, 6, 4}};
        Report report;
        const auto normals = corners_of(sheet, {40.0 * degree, {}}, report).normals;
        EXPECT_EQ(report.count("degenerate triangle"), 1U);
        const bool smooth = normals[1] == normals[6];
        EXPECT_EQ(smooth, angle < 40.0);
        if (!smooth) {
            EXPECT_EQ(normals[1], facing_up);
        }
    }
}

TEST(CornerNormals, CollapsedTrianglesChangeNothing) {
    const Mesh sphere = test::sphere(8, 4);
    Mesh collapsed = sphere;
    // At the pole and at an edge, each vertex of the pole is at the same position.
    for (std::uint32_t v = 0; v < 8; ++v) {
        collapsed.triangles.insert(collapsed.triangles.begin(), {v + 1, v, v + 10});
        collapsed.triangles.emplace_back(v + 10, v + 10, v + 20);
    }
    for (const double crease : {20.0, 40.0, 60.0}) {
        const auto expected = creased(sphere, crease);
        const auto normals = creased(collapsed, crease);
        for (std::size_t c = 0; c < expected.size(); ++c)
            ASSERT_EQ(normals[c + 3 * 8], expected[c]) << crease << ", corner " << c;
    }
}

TEST(CornerNormals, SmoothingGroupsKeepToThemselvesAndOffIsFlat) {
    const Mesh sheet = folded_sheet(40.0);
    Report report;
    const auto with_groups = [&](const std::vector<std::uint32_t>& groups,
                                 std::optional<double> crease = {}) {
        return corners_of(sheet, {crease, groups}, report).normals;
    };
    EXPECT_EQ(with_groups({1, 1, 1, 1})[1], with_groups({1, 1, 1, 1})[6]);
    EXPECT_EQ(with_groups({1, 1, 2, 2})[1], facing_up);
    EXPECT_NEAR(degrees_between(with_groups({1, 1, 2, 2})[6], facing_up), 40.0, 1e-4);
    EXPECT_EQ(with_groups({7, 7, 7, 7}, 30.0 * degree)[1], facing_up);
    const auto off = with_groups({0, 0, 0, 0});
    EXPECT_EQ(off[1], facing_up);
    EXPECT_NEAR(degrees_between(off[6], facing_up), 40.0, 1e-4);
    EXPECT_TRUE(report.empty());
}

TEST(CornerNormals, SeamsOfTextureDoNotShowAndHardEdgesFollowThem) {
    const Mesh sphere = test::sphere(24, 12);
    Report report;
    const auto smooth = corners_of(sphere, {60.0 * degree, {}}, report, NormalWeight::max).normals;
    for (std::size_t c = 0; c < smooth.size(); ++c) {
        const std::uint32_t vertex = sphere.triangles[c / 3][static_cast<int>(c % 3)];
        EXPECT_LE(degrees_between(smooth[c], sphere.normals[vertex]), 1e-3);
    }
}

TEST(CornerNormals, OrderOfTrianglesAndCornersChangesNoBit) {
    std::vector<test::NamedMesh> meshes = test::hard_meshes();
    meshes.push_back({"sphere", test::sphere(20, 10)});
    meshes.push_back({"cube", test::cube()});
    for (const test::NamedMesh& hard : meshes) {
        SCOPED_TRACE(hard.name);
        const std::vector<std::size_t> order = test::shuffled(hard.mesh.triangles.size());
        const Mesh permuted = test::with_triangle_order(hard.mesh, order);
        for (const double angle : {0.0, 30.0, 180.0}) {
            const auto expected = creased(hard.mesh, angle);
            const auto normals = creased(permuted, angle);
            for (std::size_t t = 0; t < order.size(); ++t) {
                for (std::size_t i = 0; i < 3; ++i)
                    ASSERT_EQ(normals[3 * t + i], expected[3 * order[t] + i]) << angle;
            }
            for (const glm::vec3& normal : normals)
                ASSERT_TRUE(std::abs(glm::length(glm::dvec3(normal)) - 1.0) <= 2e-7);
        }
    }
}

TEST_LABELS(not_sanitized);
TEST(CornerNormals, EdgeOfAHundredThousandTrianglesIsFast) {
    // All triangles share one edge. A comparison of every pair would take 5e9 steps.
    Mesh book;
    book.positions = {{0, 0, 0}, {0, 1, 0}};
    for (std::uint32_t i = 0; i < 100000; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 100000.0;
        book.positions.emplace_back(std::cos(angle), 0.5, std::sin(angle));
        book.triangles.emplace_back(0, 1, i + 2);
    }
    const auto normals = creased(book, 0.01);
    EXPECT_EQ(normals[0], normals[3]);
    EXPECT_EQ(normals[0], normals[150000]);
}

TEST(CornerNormals, OptionsOutOfRangeAreRefused) {
    const Mesh sheet = folded_sheet(0.0);
    Report report;
    EXPECT_THAT(
        [&] {
            corners_of(sheet, {4.0, {}}, report);
        },
        testing::ThrowsMessage<InvalidInput>(testing::HasSubstr("0 to pi")));
    const std::vector<std::uint32_t> groups(3, 1);
    EXPECT_THAT(
        [&] {
            corners_of(sheet, {std::nullopt, groups}, report);
        },
        testing::ThrowsMessage<InvalidInput>(
            testing::StrEq("there are 3 smoothing groups, but 4 triangles")));
}

TEST(InferredCreases, CubeHasItsEdgesAtHalfARightAngle) {
    const InferredCreases found = inferred_creases(test::cube());
    EXPECT_EQ(found.edges, 18U);
    EXPECT_EQ(found.hard, 12U);
    EXPECT_NEAR(glm::degrees(found.crease_angle), 45.0, 1e-6);
    EXPECT_EQ(found.misclassified, 0U);
}

TEST(InferredCreases, SmoothMeshHasNone) {
    const InferredCreases found = inferred_creases(test::sphere(12, 8));
    EXPECT_GT(found.edges, 100U);
    EXPECT_EQ(found.hard, 0U);
    EXPECT_EQ(found.crease_angle, std::numbers::pi);
}

TEST(InferredCreases, FacetsHaveNoSeparatingAngle) {
    Mesh facets = test::soup(test::sphere(12, 8));
    Report report;
    const std::vector<glm::vec3> normals =
        triangle_normals(facets.positions, facets.triangles, report);
    for (std::size_t t = 0; t < facets.triangles.size(); ++t) {
        for (int corner = 0; corner < 3; ++corner)
            facets.normals[facets.triangles[t][corner]] = normals[t];
    }
    const InferredCreases found = inferred_creases(facets);
    EXPECT_GT(found.hard, found.edges / 2);
    EXPECT_LT(glm::degrees(found.crease_angle), 12.0);
}

/// A strip along the x axis. Each of its lines has a bend in degrees and is hard or smooth.
Mesh strip(const std::vector<std::pair<double, bool>>& bends) {
    Mesh mesh;
    glm::dvec2 place(0.0);
    double angle = 0.0;
    const auto add_line = [&](double normal_angle) {
        for (const double y : {0.0, 1.0}) {
            mesh.positions.emplace_back(place.x, y, place.y);
            mesh.normals.emplace_back(std::sin(glm::radians(normal_angle)), 0.0,
                                      std::cos(glm::radians(normal_angle)));
        }
    };
    const auto step = [&] {
        place += glm::dvec2(std::cos(glm::radians(angle)), -std::sin(glm::radians(angle)));
    };
    const auto add_quad = [&](std::uint32_t left, std::uint32_t right) {
        mesh.triangles.emplace_back(left, right, right + 1);
        mesh.triangles.emplace_back(left, right + 1, left + 1);
    };
    add_line(0.0);
    std::uint32_t left = 0;
    for (const auto& [bend, is_hard] : bends) {
        step();
        add_line(is_hard ? angle : angle + 0.5 * bend);
        const auto line = static_cast<std::uint32_t>(mesh.positions.size()) - 2;
        add_quad(left, line);
        angle += bend;
        left = line;
        if (!is_hard) continue;
        add_line(angle);
        left = line + 2;
    }
    step();
    add_line(angle);
    add_quad(left, static_cast<std::uint32_t>(mesh.positions.size()) - 2);
    return mesh;
}

TEST(InferredCreases, PartAtTheAngleWithTheFewestMisjudged) {
    // The diagonals of the quads are five edges with an angle of 0.
    const InferredCreases clear =
        inferred_creases(strip({{10.0, false}, {20.0, false}, {50.0, true}, {70.0, true}}));
    EXPECT_EQ(clear.edges, 4U + 5U);
    EXPECT_EQ(clear.hard, 2U);
    EXPECT_NEAR(glm::degrees(clear.crease_angle), 35.0, 1e-3);
    EXPECT_EQ(clear.misclassified, 0U);
    const InferredCreases mixed =
        inferred_creases(strip({{15.0, true}, {30.0, false}, {50.0, true}, {70.0, true}}));
    EXPECT_NEAR(glm::degrees(mixed.crease_angle), 40.0, 1e-3);
    EXPECT_EQ(mixed.misclassified, 1U);
}

TEST(InferredCreases, NeedNormals) {
    Mesh mesh = test::cube();
    mesh.normals.clear();
    EXPECT_THROW(inferred_creases(mesh), InvalidInput);
}

}  // namespace
}  // namespace relief
