// SPDX-License-Identifier: Apache-2.0
// Decimation: the number of triangles, the distance to the original surface, seams, boundaries and
// hard meshes.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>

#include "geometry/weld.h"
#include "mesh/topology/boundary_edges.h"
#include "relief/mesh/decimate.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"
#include "support/message_of.h"
#include "support/shapes.h"
#include "support/shared_data.h"
#include "topology/topology.h"

namespace relief {
namespace {

using test::boundary_edges;
using test::message_of;

Mesh decimated_to(const Mesh& mesh, std::size_t triangles, Report& report,
                  NormalMode normals = NormalMode::keep) {
    return decimated(mesh, {triangles, {}, {.normals = normals}}, report).mesh;
}

glm::dvec3 normal_of(const Mesh& mesh, const glm::uvec3& t) {
    const glm::dvec3 a(mesh.positions[t.x]);
    return glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
}

/// Returns twice the signed area in the texture.
double texture_area(const Mesh& mesh, const glm::uvec3& t) {
    const glm::dvec2 a(mesh.texcoords[t.x]);
    const glm::dvec2 b = glm::dvec2(mesh.texcoords[t.y]) - a;
    const glm::dvec2 c = glm::dvec2(mesh.texcoords[t.z]) - a;
    return b.x * c.y - b.y * c.x;
}

/// Visits points of every triangle with their texture coordinates.
template <typename Visit>
void for_each_sample(const Mesh& mesh, const Visit& visit) {
    for (const glm::uvec3& t : mesh.triangles) {
        for (const glm::dvec3 w :
             {glm::dvec3(1, 1, 1), glm::dvec3(4, 1, 1), glm::dvec3(1, 4, 1), glm::dvec3(1, 1, 4)}) {
            const glm::dvec3 weight = w / (w.x + w.y + w.z);
            glm::dvec3 p(0.0);
            glm::dvec2 uv(0.0);
            for (int i = 0; i < 3; ++i) {
                p += weight[i] * glm::dvec3(mesh.positions[t[i]]);
                uv += weight[i] * glm::dvec2(mesh.texcoords[t[i]]);
            }
            visit(p, uv);
        }
    }
}

/// Returns the point of the unit sphere of support/shapes.h at a texture coordinate.
glm::dvec3 on_sphere(const glm::dvec2& uv) {
    using std::numbers::pi;
    const double ring = std::sin(uv.y * pi);
    return {ring * std::sin(uv.x * 2.0 * pi), std::cos(uv.y * pi),
            ring * std::cos(uv.x * 2.0 * pi)};
}

/// Rotates about the y axis by the start of longitude of a sphere.
glm::dvec3 turned(const glm::dvec3& p, double angle) {
    return {p.x * std::cos(angle) + p.z * std::sin(angle), p.y,
            p.z * std::cos(angle) - p.x * std::sin(angle)};
}

TEST(Decimate, MeetsTheNumberWithinOneAndStaysClosed) {
    const Mesh sphere = test::sphere(64, 32);
    for (const std::size_t wanted : {2000U, 501U, 100U}) {
        Report report;
        const Mesh small = decimated_to(sphere, wanted, report);
        validate(small);
        EXPECT_LE(small.triangles.size(), wanted);
        EXPECT_GE(small.triangles.size() + 1, wanted);
        EXPECT_EQ(boundary_edges(small), 0U);
        EXPECT_EQ(report.count("number of triangles out of reach"), 0U);
    }
}

TEST(Decimate, TheErrorOnASphereFallsWithTheNumberOfTriangles) {
    // A triangle of size h has a distance of at most h^2 / 8 to a sphere, and h^2 is proportional
    // to 1 / triangles: four times the triangles give a quarter of the error.
    const Mesh sphere = test::sphere(128, 64);
    std::vector<double> errors;
    for (const std::size_t wanted : {125U, 500U, 2000U}) {
        Report report;
        double most = 0.0;
        const Mesh small = decimated_to(sphere, wanted, report);
        for_each_sample(small, [&](const glm::dvec3& p, const glm::dvec2&) {
            most = std::max(most, 1.0 - glm::length(p));
        });
        errors.push_back(most);
    }
    EXPECT_LT(errors[0], 0.25);
    EXPECT_LT(errors[1], errors[0] / 2.0);
    EXPECT_LT(errors[2], errors[1] / 2.0);
    EXPECT_LT(errors[2], 0.012);
}

TEST(Decimate, ASeamIsNeitherTornNorSmeared) {
    const Mesh sphere = test::sphere(96, 48);
    // The start of longitude of this sphere.
    const std::size_t equator = sphere.positions.size() / 2;
    const glm::dvec3 fitted = on_sphere(sphere.texcoords[equator]);
    const glm::dvec3 there(sphere.positions[equator]);
    const double angle = std::atan2(there.x, there.z) - std::atan2(fitted.x, fitted.z);
    Report report;
    const Mesh small = decimated_to(sphere, 900, report, NormalMode::angle);
    double worst = 0.0;
    double sum = 0.0;
    std::size_t count = 0;
    for_each_sample(small, [&](const glm::dvec3& p, const glm::dvec2& uv) {
        // Near a pole, the map of longitude differs from triangle to triangle.
        if (uv.y < 0.1 || uv.y > 0.9) return;
        const double away = glm::length(turned(on_sphere(uv), angle) - p);
        worst = std::max(worst, away);
        sum += away;
        ++count;
    });
    ASSERT_GT(count, 1000U);
    // A smeared seam would have an error of up to the diameter of the sphere. Triangles are 0.17
    // wide here.
    EXPECT_LT(worst, 0.1);
    EXPECT_LT(sum / static_cast<double>(count), 0.02);
    EXPECT_EQ(boundary_edges(small), 0U) << "not torn";
}

TEST(Decimate, NothingTurnsOverInSpaceOrInTheTexture) {
    const Mesh sphere = test::sphere(64, 32);
    Report report;
    const Mesh small = decimated_to(sphere, 300, report);
    for (const glm::uvec3& t : small.triangles) {
        EXPECT_GT(glm::dot(normal_of(small, t), glm::dvec3(small.positions[t.x])), 0.0);
        EXPECT_GE(texture_area(small, t) * texture_area(sphere, sphere.triangles[500]), 0.0);
    }
}

TEST(Decimate, APlaneBecomesTwoTrianglesWithItsTextureExact) {
    Report report;
    const Mesh small = decimated_to(test::grid(20), 2, report);
    ASSERT_EQ(small.triangles.size(), 2U);
    EXPECT_EQ(small.positions.size(), 4U) << "its corners";
    for_each_sample(small, [](const glm::dvec3& p, const glm::dvec2& uv) {
        EXPECT_NEAR(p.x, uv.x, 1e-6);
        EXPECT_NEAR(p.y, 1.0 - uv.y, 1e-6);
        EXPECT_NEAR(p.z, 0.0, 1e-6);
    });
    EXPECT_TRUE(report.empty());
}

TEST(Decimate, HardEdgesStayWithNormalsKeptAndNotWithNewOnes) {
    // A cube keeps its 12 triangles, because no corner can be removed.
    Report report;
    const Mesh kept = decimated_to(test::cube(), 1, report);
    EXPECT_EQ(kept.triangles.size(), 12U);
    EXPECT_EQ(kept.normals.size(), 24U);
    EXPECT_EQ(report.count("number of triangles out of reach"), 1U);
}

TEST(Decimate, MaterialsKeepTheirBordersAndRanges) {
    Mesh grid = test::grid(16);
    const auto half = static_cast<std::uint32_t>(grid.triangles.size() / 2);
    grid.material_ranges = {{0, half, 0U}, {half, half, 1U}};
    Report report;
    const Mesh small = decimated_to(grid, 4, report);
    ASSERT_EQ(small.material_ranges.size(), 2U);
    for (const MaterialRange& range : small.material_ranges) {
        EXPECT_EQ(range.triangle_count, 2U);
        double area = 0.0;
        for (std::uint32_t t = 0; t < range.triangle_count; ++t)
            area += glm::length(normal_of(small, small.triangles[range.first_triangle + t])) / 2.0;
        EXPECT_NEAR(area, 0.5, 1e-6) << "its half of the square";
    }
    EXPECT_EQ(small.material_ranges[1].material, 1U);
}

TEST(Decimate, SmoothingGroupsGoWithTheirTriangles) {
    // The materials are left and right of the middle, and the smoothing groups are the same halves.
    Mesh sphere = test::sphere(32, 16);
    const auto half = static_cast<std::uint32_t>(sphere.triangles.size() / 2);
    sphere.material_ranges = {{0, half, 0U}, {half, half, 1U}};
    sphere.smoothing_groups.assign(sphere.triangles.size(), 3);
    std::fill(sphere.smoothing_groups.begin() + half, sphere.smoothing_groups.end(), 5);
    DecimateOptions options;
    options.triangles = 200;
    Report report;
    const Mesh small = decimated(sphere, options, report).mesh;
    ASSERT_EQ(small.smoothing_groups.size(), small.triangles.size());
    ASSERT_EQ(small.material_ranges.size(), 2U);
    for (std::size_t t = 0; t < small.triangles.size(); ++t) {
        const bool is_first = t < small.material_ranges[0].triangle_count;
        EXPECT_EQ(small.smoothing_groups[t], is_first ? 3U : 5U) << t;
    }
}

TEST(Decimate, ATextureIslandOfOneTriangleDoesNotVanish) {
    Mesh grid = test::grid(8);
    const auto last = static_cast<std::uint32_t>(grid.triangles.size() - 1);
    // A triangle in the middle has its own material and moves to the end.
    std::swap(grid.triangles[last / 2], grid.triangles[last]);
    grid.material_ranges = {{0, last, 0U}, {last, 1, 1U}};
    Report report;
    const Mesh small = decimated_to(grid, 1, report);
    EXPECT_EQ(small.material_ranges[1].triangle_count, 1U);
    EXPECT_GT(report.count("number of triangles out of reach"), 0U);
}

/// Returns the squared distance to a triangle by a search over a fine grid of its points.
double distance_to(const glm::dvec3& p, const Mesh& mesh) {
    double nearest = std::numeric_limits<double>::infinity();
    constexpr int steps = 24;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]);
        const glm::dvec3 b(mesh.positions[t.y]);
        const glm::dvec3 c(mesh.positions[t.z]);
        for (int i = 0; i <= steps; ++i) {
            for (int j = 0; i + j <= steps; ++j) {
                const glm::dvec3 q =
                    a + (b - a) * (i / double(steps)) + (c - a) * (j / double(steps));
                nearest = std::min(nearest, glm::length(p - q));
            }
        }
    }
    return nearest;
}

TEST(Decimate, NoVertexComesToLieFurtherAwayThanMaxError) {
    const Mesh torus = make_torus(0.4F, 32, 16);
    for (const double most : {0.05, 0.01}) {
        Report report;
        const Mesh small =
            decimated(torus, {{}, most, {.normals = NormalMode::angle}}, report).mesh;
        EXPECT_LT(small.triangles.size(), torus.triangles.size());
        double worst = 0.0;
        for (const glm::vec3& p : torus.positions)
            worst = std::max(worst, distance_to(glm::dvec3(p), small));
        // The grid of the search is up to 1/40 of a triangle from the nearest point; along the
        // surface, that is a second-order error.
        EXPECT_LT(worst, most * 1.1 + 0.005);
        EXPECT_GT(worst, most * 0.5) << "the bound is made use of";
    }
    Report report;
    EXPECT_EQ(
        decimated(torus, {{}, 0.0, {.normals = NormalMode::angle}}, report).mesh.triangles.size(),
        torus.triangles.size())
        << "no vertex of a torus is flat";
}

TEST(Decimate, TheUnitOfLengthDoesNotMatter) {
    const Mesh torus = make_torus(0.4F, 24, 12);
    Report report;
    const std::vector<glm::uvec3> triangles = decimated_to(torus, 200, report).triangles;
    for (const float scale : {0x1p-90F, 0x1p+90F}) {
        Mesh scaled = torus;
        for (glm::vec3& p : scaled.positions)
            p *= scale;
        EXPECT_EQ(decimated_to(scaled, 200, report).triangles, triangles) << scale;
    }
}

TEST(Decimate, NonManifoldEdgesStayAsTheyAre) {
    // Three grids that share an edge.
    Mesh mesh;
    const Mesh grid = test::grid(8);
    for (int sheet = 0; sheet < 3; ++sheet) {
        const double angle = 2.0 * sheet;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const glm::vec3& p : grid.positions)
            mesh.positions.emplace_back(p.x * std::cos(angle), p.y, p.x * std::sin(angle));
        for (const glm::uvec3& t : grid.triangles)
            mesh.triangles.push_back(t + first);
    }
    // The coordinates at the common edge x = 0 are +0 and -0.
    Report report;
    const Mesh small = decimated_to(mesh, 3, report);
    EXPECT_EQ(report.count("non-manifold edge"), 8U);
    Report again;
    decimated_to(small, 3, again);
    EXPECT_EQ(again.count("non-manifold edge"), 8U) << "the sheets still meet in every edge";
    EXPECT_LT(small.triangles.size(), mesh.triangles.size() / 4);
}

TEST(Decimate, NonFiniteTrianglesComeBackAndDegenerateOnesDoNot) {
    Mesh grid = test::grid(6);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    grid.positions.emplace_back(nan, 0.0F, 0.0F);
    grid.positions.emplace_back(9.0F, 9.0F, 9.0F);
    grid.normals.resize(grid.positions.size(), glm::vec3(0, 0, 1));
    grid.texcoords.resize(grid.positions.size(), glm::vec2(0.0F));
    grid.tangents.clear();
    const auto bad = static_cast<std::uint32_t>(grid.positions.size() - 2);
    grid.triangles.emplace_back(0, 1, bad);
    grid.triangles.emplace_back(3, 3, 4);
    grid.material_ranges.clear();
    Report report;
    const Mesh small = decimated_to(grid, 3, report);
    EXPECT_EQ(small.triangles.size(), 3U);
    EXPECT_TRUE(std::isnan(small.positions[small.triangles.back().z].x));
    EXPECT_EQ(report.count("triangle with a non-finite position"), 1U);
    EXPECT_EQ(report.count("collapsed triangle"), 1U);
    EXPECT_EQ(report.count("isolated vertex"), 1U);
}

TEST(Decimate, EmptyAndSmallestMeshes) {
    Report report;
    EXPECT_TRUE(decimated_to({}, 1, report).triangles.empty());
    Mesh one;
    one.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    one.triangles = {{0, 1, 2}};
    EXPECT_EQ(decimated_to(one, 1, report).triangles, one.triangles);
    EXPECT_EQ(decimated(one, {{}, 100.0, {}}, report).mesh.triangles, one.triangles);
    EXPECT_TRUE(report.empty());
}

TEST(Decimate, VerticesCarryWhatTheyHadAndSayWhereFrom) {
    Mesh sphere = test::sphere(32, 16);
    for (const glm::vec3& p : sphere.positions)
        sphere.colors.emplace_back(p * 0.5F + 0.5F, 1.0F);
    Report report;
    const FramedMesh small = decimated(sphere, {200, {}, {}}, report);
    ASSERT_EQ(small.source_vertex.size(), small.mesh.positions.size());
    for (std::size_t v = 0; v < small.source_vertex.size(); ++v) {
        const std::uint32_t source = small.source_vertex[v];
        EXPECT_EQ(small.mesh.positions[v], sphere.positions[source]);
        EXPECT_EQ(small.mesh.normals[v], sphere.normals[source]);
        EXPECT_EQ(small.mesh.texcoords[v], sphere.texcoords[source]);
        EXPECT_EQ(small.mesh.colors[v], sphere.colors[source]);
    }
}

TEST(Decimate, TangentsAreComputedAnewAndThatIsSaid) {
    Mesh sphere = test::sphere(32, 16);
    sphere.tangents.assign(sphere.positions.size(), glm::vec4(1, 0, 0, 1));
    Report report;
    const Mesh small = decimated_to(sphere, 200, report);
    EXPECT_EQ(report.count("tangents of other triangles"), 1U);
    ASSERT_EQ(small.tangents.size(), small.positions.size());
    for (const glm::uvec3& t : small.triangles)
        EXPECT_NEAR(glm::dot(glm::vec3(small.tangents[t.x]), small.normals[t.x]), 0.0F, 1e-5F);
    sphere.texcoords.clear();
    EXPECT_TRUE(decimated_to(sphere, 200, report).tangents.empty());
}

TEST(Decimate, RefusesLimitsThatAreNone) {
    Report report;
    const auto refusal = [&](const DecimateOptions& options) {
        return message_of<InvalidInput>([&] { decimated(test::grid(2), options, report); });
    };
    EXPECT_EQ(refusal({}), "decimation needs a number of triangles or an error to stop at");
    EXPECT_EQ(refusal({0, {}, {}}), "0 triangles are no surface; at least 1 must be left");
    EXPECT_EQ(refusal({{}, -1.0, {}}), "an error of -1 is no distance");
    EXPECT_EQ(refusal({{}, std::nan(""), {}}), "an error of nan is no distance");
}

TEST(Decimate, ARealModelKeepsItsTexture) {
    RELIEF_NEEDS_SHARED(file, "data/models/obj/spot/spot_triangulated.obj");
    Report report;
    const Mesh spot = read_mesh(file, report).mesh;
    const Mesh small = decimated_to(spot, 1500, report, NormalMode::angle);
    EXPECT_EQ(small.triangles.size(), 1500U);
    EXPECT_EQ(boundary_edges(small), boundary_edges(spot));
    // The position on the original with the same texture coordinate: that of the nearest vertex.
    double sum = 0.0;
    std::size_t count = 0;
    for_each_sample(small, [&](const glm::dvec3& p, const glm::dvec2& uv) {
        double nearest = std::numeric_limits<double>::infinity();
        glm::dvec3 place(0.0);
        for (std::size_t v = 0; v < spot.positions.size(); ++v) {
            const glm::dvec2 away = glm::dvec2(spot.texcoords[v]) - uv;
            if (glm::dot(away, away) >= nearest) continue;
            nearest = glm::dot(away, away);
            place = spot.positions[v];
        }
        sum += glm::length(place - p);
        ++count;
    });
    // Its edges have a mean length of 0.03, and its height is 1.8.
    EXPECT_LT(sum / static_cast<double>(count), 0.03);
}

}  // namespace
}  // namespace relief
