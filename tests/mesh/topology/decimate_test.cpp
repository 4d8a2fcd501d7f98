// SPDX-License-Identifier: Apache-2.0
// Decimation: the number of triangles, the distance to the original surface, seams, boundaries and
// attributes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>

#include "geometry/weld.h"
#include "mesh/topology/boundary_edges.h"
#include "mesh/topology/decimated_to.h"
#include "portable_math.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"
#include "relief/mesh/topology.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/sanitized.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using test::boundary_edges;
using test::decimated_to;
using test::message_of;

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
    const Mesh small = decimated_to(sphere, 900, report, NormalWeight::angle);
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

TEST(Decimate, InvertsNoTriangleInSpaceOrTexture) {
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

/// Returns the distance to the nearest triangle by a search over a fine grid of its points.
double distance_to(const glm::dvec3& p, const Mesh& mesh) {
    double nearest = std::numeric_limits<double>::infinity();
    constexpr int steps = 24;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]);
        const glm::dvec3 b(mesh.positions[t.y]);
        const glm::dvec3 c(mesh.positions[t.z]);
        // No point of the triangle is farther from its first corner than the other corners are.
        const double extent = std::max(glm::length(b - a), glm::length(c - a));
        if (glm::length(p - a) - extent > nearest) continue;
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

TEST_LABELS(not_sanitized);
TEST(Decimate, TheSurfacesAreNowhereFurtherApartThanMaxError) {
    const Mesh torus = make_torus(0.4F, 64, 32);
    for (const double most : {0.05, 0.02}) {
        Report report;
        const Mesh small =
            decimated(torus, {{}, most, {.normals = NormalWeight::angle}}, report).mesh;
        EXPECT_LT(small.triangles.size(), torus.triangles.size());
        double worst = 0.0;
        for (std::size_t v = 0; v < torus.positions.size(); v += 31)
            worst = std::max(worst, distance_to(glm::dvec3(torus.positions[v]), small));
        // The grid of the search is up to 1/40 of a triangle from the nearest point; along the
        // surface, that is a second-order error.
        EXPECT_LT(worst, most * 1.1 + 0.005);
        const SurfaceDistance distance = surface_distance(torus, small);
        const double largest = std::max(distance.from_a.max, distance.from_b.max);
        EXPECT_LE(largest, most);
        EXPECT_GT(largest, most * 0.4) << "the bound is made use of";
    }
    Report report;
    EXPECT_EQ(
        decimated(torus, {{}, 0.0, {.normals = NormalWeight::angle}}, report).mesh.triangles.size(),
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

TEST(Decimate, SheetsStillMeetAtANonManifoldEdge) {
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
    EXPECT_EQ(again.count("non-manifold edge"), 1U) << "the line is one edge of all sheets";
    EXPECT_LT(small.triangles.size(), 10U);
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

TEST(Decimate, VerticesKeepAttributesAndSourceIndices) {
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

TEST(Decimate, RecomputesTangentsWithAFinding) {
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
    EXPECT_EQ(refusal({0, {}, {}}), "the number of triangles is 0, but must be at least 1");
    EXPECT_EQ(refusal({{}, -1.0, {}}),
              "the maximum error is -1, but must be finite and at least 0");
    EXPECT_EQ(refusal({{}, std::nan(""), {}}),
              "the maximum error is nan, but must be finite and at least 0");
}

TEST(Decimate, ARealModelKeepsItsTexture) {
    RELIEF_NEEDS_SHARED(file, "data/models/obj/spot/spot_triangulated.obj");
    Report report;
    const Mesh spot = read_mesh(file, report).mesh;
    const Mesh small = decimated_to(spot, 1500, report, NormalWeight::angle);
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

/// Returns the triangles of a mesh as sorted positions of their corners.
std::vector<std::array<float, 9>> triangle_positions(const Mesh& mesh) {
    std::vector<std::array<float, 9>> result;
    for (const glm::uvec3& t : mesh.triangles) {
        std::array<float, 9> values{};
        for (int i = 0; i < 3; ++i) {
            for (int k = 0; k < 3; ++k)
                values[static_cast<std::size_t>(3 * i + k)] = mesh.positions[t[i]][k];
        }
        result.push_back(values);
    }
    std::sort(result.begin(), result.end());
    return result;
}

TEST(Decimate, IsIndependentOfOrderAndThreads) {
    Mesh sphere = test::sphere(128, 64);
    DecimateOptions options;
    options.triangles = 700;
    Report report;
    const auto expected = triangle_positions(decimated(sphere, options, report).mesh);
    std::mt19937 random(5);
    for (const int threads : {1, 2}) {
        std::shuffle(sphere.triangles.begin(), sphere.triangles.end(), random);
        set_thread_limit(threads);
        EXPECT_EQ(triangle_positions(decimated(sphere, options, report).mesh), expected);
    }
    set_thread_limit(0);
}

TEST(Decimate, NoTriangleIsInvertedOnTori) {
    // Each move rotates a triangle by less than 90 degrees, but several moves add up.
    for (const auto& [slices, sides] : {std::pair(223, 223), std::pair(20, 250), std::pair(20, 70),
                                        std::pair(140, 10), std::pair(80, 70)}) {
        for (const float tube_radius : {0.4F, 0.25F, 0.8F}) {
            const Mesh torus = make_torus(tube_radius, slices, sides);
            if ((tube_radius != 0.4F || test::is_sanitized) && torus.triangles.size() > 20000)
                continue;
            for (const bool fits : {true, false}) {
                DecimateOptions options;
                options.triangles = std::max<std::size_t>(torus.triangles.size() / 100, 40);
                options.fit_positions = fits;
                Report report;
                const FramedMesh small = decimated(torus, options, report);
                EXPECT_LT(max_corner_angle(torus, small), std::numbers::pi / 2.0)
                    << slices << " x " << sides << ", " << tube_radius << ", " << fits;
                // The shape of the torus may need more than 40 triangles.
                EXPECT_LE(small.mesh.triangles.size(),
                          std::max<std::size_t>(*options.triangles, 160));
            }
        }
    }
}

TEST(Decimate, NoTriangleIsInvertedAtSharpEdges) {
    // Thin plates with folds: the mean normal at their rims says little about the sides.
    std::mt19937 random(9);
    const auto noise = [&] { return static_cast<float>(random()) / 4294967296.0F - 0.5F; };
    for (const float thickness : {0.2F, 0.02F, 0.002F}) {
        Mesh plate = make_sphere(48, 32);
        plate.normals.clear();
        plate.tangents.clear();
        plate.texcoords.clear();
        for (glm::vec3& p : plate.positions)
            p = {p.x + 0.02F * noise(), thickness * p.y, p.z};
        DecimateOptions options;
        options.triangles = 60;
        for (const bool fits : {true, false}) {
            options.fit_positions = fits;
            const FramedMesh small = decimated(plate, options);
            EXPECT_LE(max_corner_angle(plate, small), std::numbers::pi / 2.0 + 1e-6) << thickness;
        }
    }
}

TEST(Decimate, AMaximumAngleOfNormalsHolds) {
    const Mesh torus = make_torus(0.4F, 64, 32);
    DecimateOptions options;
    options.triangles = 1;
    options.frames.normals = NormalWeight::angle;
    options.max_normal_error = 0.2;
    Report report;
    const Mesh small = decimated(torus, options, report).mesh;
    EXPECT_LT(small.triangles.size(), torus.triangles.size() / 2);
    for (const glm::uvec3& t : small.triangles) {
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 p(small.positions[t[i]]);
            const glm::dvec3 ring = glm::normalize(glm::dvec3(p.x, 0.0, p.z));
            const double cosine =
                glm::dot(glm::normalize(p - ring), glm::normalize(normal_of(small, t)));
            // The triangles of the input are up to 6.3 degrees from the surface at their corners.
            EXPECT_GT(cosine, std::cos(0.2 + 0.11));
        }
    }
}

TEST(Decimate, AMaximumAngleOfNormalsHoldsAtHardEdgesAndDoesNotKeepFlatFaces) {
    // A cube with subdivided faces becomes its 12 triangles, however small the angle is.
    Mesh cube;
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-0.5F, 0.5F}) {
            const Mesh grid = test::grid(8);
            const auto first = static_cast<std::uint32_t>(cube.positions.size());
            for (const glm::vec3& p : grid.positions) {
                glm::vec3 q(0.0F);
                q[axis] = side;
                q[(axis + 1) % 3] = p.x - 0.5F;
                q[(axis + 2) % 3] = p.y - 0.5F;
                cube.positions.push_back(q);
            }
            for (const glm::uvec3& t : grid.triangles) {
                const glm::uvec3 turned = side > 0.0F ? t : glm::uvec3(t.x, t.z, t.y);
                cube.triangles.push_back(turned + first);
            }
        }
    }
    for (const double angle : {1e-4, 0.2, 1.0}) {
        DecimateOptions options;
        options.triangles = 12;
        options.max_normal_error = angle;
        Report report;
        const FramedMesh small = decimated(cube, options, report);
        EXPECT_EQ(small.mesh.triangles.size(), 12U) << angle;
        EXPECT_NEAR(max_corner_angle(cube, small), 0.0, 1e-6) << angle;
    }
    const Mesh torus = make_torus(0.4F, 64, 32);
    std::size_t more = 0;
    for (const double angle : {0.5, 0.2, 0.05}) {
        DecimateOptions options;
        options.triangles = 1;
        options.frames.normals = NormalWeight::angle;
        options.max_normal_error = angle;
        Report report;
        for (const bool fits : {true, false}) {
            options.fit_positions = fits;
            const FramedMesh small = decimated(torus, options, report);
            const double measured = max_corner_angle(torus, small);
            EXPECT_LE(measured, angle * (1.0 + 1e-6));
            EXPECT_GT(measured, 0.6 * angle) << "the limit is made use of";
            EXPECT_GT(small.mesh.triangles.size(), fits ? more : more - 1);
            more = small.mesh.triangles.size();
        }
    }
}

TEST(Decimate, KeptBordersAndSeamsDoNotChange) {
    DecimateOptions options;
    options.triangles = 1;
    options.keep_borders = true;
    Report report;
    const Mesh grid = decimated(test::grid(12), options, report).mesh;
    EXPECT_EQ(boundary_edges(grid), 48U);
    EXPECT_LE(grid.triangles.size(), 50U) << "a polygon of 48 sides has 46 triangles";
    options.keep_borders = false;
    options.keep_seams = true;
    const Mesh sphere = decimated(test::sphere(32, 16), options, report).mesh;
    std::size_t at_seam = 0;
    for (const glm::vec2& uv : sphere.texcoords)
        at_seam += uv.x == 0.0F && uv.y > 0.0F && uv.y < 1.0F ? 1 : 0;
    EXPECT_EQ(at_seam, 15U);
}

TEST(Decimate, PaintedColorsOnAPlaneCount) {
    // A step of color from left to right in the middle of a plane: the triangles at the step stay
    // small, and without the weight the plane becomes two triangles.
    Mesh grid = test::grid(32);
    for (const glm::vec3& p : grid.positions)
        grid.colors.emplace_back(glm::vec3(std::clamp(8.0F * (p.x - 0.5F), 0.0F, 1.0F)), 1.0F);
    DecimateOptions options;
    options.triangles = 12;
    Report report;
    const auto error = [&](const Mesh& mesh) {
        double worst = 0.0;
        for (const glm::uvec3& t : mesh.triangles) {
            glm::vec3 p(0.0F);
            float color = 0.0F;
            for (int i = 0; i < 3; ++i) {
                p += mesh.positions[t[i]] / 3.0F;
                color += mesh.colors[t[i]].x / 3.0F;
            }
            worst = std::max(
                worst, std::abs(double(color) - std::clamp(8.0 * (double(p.x) - 0.5), 0.0, 1.0)));
        }
        return worst;
    };
    EXPECT_LT(error(decimated(grid, options, report).mesh), 0.05);
    options.weights.color = 0.0;
    options.triangles = 2;
    EXPECT_EQ(decimated(grid, options, report).mesh.triangles.size(), 2U);
}

/// Returns the largest difference between a value of the vertices, interpolated at the centers of
/// the triangles, and its formula.
template <typename Formula>
double worst_at_centers(const FramedMesh& small, const std::vector<double>& values,
                        const Formula& formula) {
    double worst = 0.0;
    for (const glm::uvec3& t : small.mesh.triangles) {
        glm::dvec3 center(0.0);
        double value = 0.0;
        for (int i = 0; i < 3; ++i) {
            center += glm::dvec3(small.mesh.positions[t[i]]) / 3.0;
            value += values[small.source_vertex[t[i]]] / 3.0;
        }
        worst = std::max(worst, std::abs(value - formula(center.x)));
    }
    return worst;
}

TEST(Decimate, JointWeightsAndDisplacementsOnAPlaneCount) {
    // A plane that bends at x = 0.5, by a joint or by a morph target.
    const Mesh grid = test::grid(32);
    const auto bent = [](double x) { return std::clamp(8.0 * (x - 0.5), 0.0, 1.0); };
    std::vector<double> values;
    Deformation joints;
    Deformation target;
    for (const glm::vec3& p : grid.positions) {
        const auto value = static_cast<float>(bent(double(p.x)));
        values.push_back(double(value));
        joints.joints.emplace_back(value, -value, 0.0F, 0.0F);
        target.displacements[1].emplace_back(0.0F, 0.0F, 0.2F * value);
    }
    DecimateOptions options;
    options.triangles = 12;
    options.weights.joint = 0.1;
    Report report;
    for (const Deformation* deformation : {&joints, &target}) {
        const FramedMesh small = decimated(grid, options, report, *deformation);
        EXPECT_EQ(small.mesh.triangles.size(), 12U);
        EXPECT_LT(worst_at_centers(small, values, bent), 0.05);
    }
    EXPECT_GT(worst_at_centers(decimated(grid, options, report), values, bent), 0.2);
    options.weights.joint = 0.0;
    EXPECT_GT(worst_at_centers(decimated(grid, options, report, joints), values, bent), 0.2);
    options.weights.target = 0.0;
    EXPECT_GT(worst_at_centers(decimated(grid, options, report, target), values, bent), 0.2);
    target.displacements[1].pop_back();
    EXPECT_EQ(message_of<InvalidInput>([&] { decimated(grid, options, report, target); }),
              "there are 1088 displacements, but 1089 positions");
}

TEST(Decimate, LinearJointWeightsHaveNoError) {
    Mesh grid = test::grid(32);
    Deformation deformation;
    for (const glm::vec3& p : grid.positions)
        deformation.joints.emplace_back(p.x, 1.0F - p.x, 0.0F, p.y);
    DecimateOptions options;
    options.max_error = 1e-6;
    Report report;
    EXPECT_EQ(decimated(grid, options, report, deformation).mesh.triangles.size(), 2U);
}

TEST(Decimate, PartsThatTouchAtRestStayApart) {
    // Lips: two grids with common positions at x = 1 that move apart, by a morph target or because
    // they belong to different joints. Nothing else differs between the vertices there.
    const Mesh grid = test::grid(8);
    Mesh lips;
    const auto count = static_cast<std::uint32_t>(grid.positions.size());
    for (const float shift : {0.0F, 1.0F}) {
        const auto first = static_cast<std::uint32_t>(lips.positions.size());
        for (const glm::vec3& p : grid.positions)
            lips.positions.push_back(p + glm::vec3(shift, 0.0F, 0.0F));
        for (const glm::uvec3& t : grid.triangles)
            lips.triangles.push_back(t + first);
    }
    Deformation by_target;
    Deformation by_joint;
    for (std::uint32_t v = 0; v < 2 * count; ++v) {
        const float side = v < count ? 1.0F : -1.0F;
        by_target.displacements[0].emplace_back(0.0F, 0.0F, side);
        by_joint.joints.emplace_back(side, 0.0F, 0.0F, 0.0F);
    }
    DecimateOptions options;
    options.triangles = 4;
    Report report;
    for (const Deformation* deformation : {&by_target, &by_joint}) {
        const FramedMesh small = decimated(lips, options, report, *deformation);
        EXPECT_EQ(small.mesh.triangles.size(), 4U);
        EXPECT_EQ(small.mesh.positions.size(), 8U);
        for (const glm::uvec3& t : small.mesh.triangles) {
            const bool is_left = small.source_vertex[t.x] < count;
            EXPECT_EQ(small.source_vertex[t.y] < count, is_left);
            EXPECT_EQ(small.source_vertex[t.z] < count, is_left);
        }
    }
    options.triangles = 2;
    EXPECT_EQ(decimated(lips, options, report).mesh.triangles.size(), 2U) << "one sheet at rest";
}

/// Returns the RMS distance of the triangles of a mesh from the torus of radii 1 and 0.4 about y.
double distance_from_torus(const Mesh& mesh) {
    double sum = 0.0;
    std::size_t count = 0;
    for_each_sample(mesh, [&](const glm::dvec3& p, const glm::dvec2&) {
        const double ring = std::hypot(p.x, p.z) - 1.0;
        const double distance = std::hypot(ring, p.y) - 0.4;
        sum += distance * distance;
        ++count;
    });
    return std::sqrt(sum / static_cast<double>(count));
}

TEST(DecimateFit, HalvesTheDistanceOnCurvedSurfacesAndKeepsTheRest) {
    const Mesh torus = make_torus(0.4F, 128, 64);
    DecimateOptions options;
    options.triangles = 800;
    options.goal = DecimateGoal::distance;
    options.weights.normal = 0.0;
    Report report;
    const FramedMesh subset = decimated(torus, options, report);
    options.fit_positions = true;
    const FramedMesh fitted = decimated(torus, options, report);
    EXPECT_LT(distance_from_torus(fitted.mesh), 0.5 * distance_from_torus(subset.mesh));
    EXPECT_LE(subset.mesh.triangles.size() - fitted.mesh.triangles.size() + 1, 2U);
    EXPECT_EQ(boundary_edges(fitted.mesh), 0U) << "vertices at one position move together";
    for (std::size_t v = 0; v < fitted.mesh.positions.size(); ++v) {
        const std::uint32_t source = fitted.source_vertex[v];
        EXPECT_EQ(fitted.mesh.texcoords[v], torus.texcoords[source]);
        EXPECT_EQ(fitted.mesh.normals[v], torus.normals[source]);
        EXPECT_LT(glm::length(fitted.mesh.positions[v] - torus.positions[source]), 0.04F);
    }
}

/// Returns a sphere whose radius differs at each vertex, by 0.2 % on average.
Mesh rough_sphere() {
    Mesh mesh = make_sphere(160, 80);
    detail::Random random(11);
    const std::vector<std::uint32_t> classes = detail::weld_positions(mesh.positions);
    std::vector<float> radii(mesh.positions.size());
    for (float& radius : radii)
        radius = 1.0F + 0.003F * static_cast<float>(random.between(-1.0, 1.0));
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        mesh.positions[v] *= radii[classes[v]];
    mesh.normals.clear();
    mesh.tangents.clear();
    return mesh;
}

// Planes of rough triangles say less about the surface than those of the surface in between.
TEST(DecimateFit, FollowsRoughSurfacesByPlanesInBetween) {
    const Mesh rough = rough_sphere();
    DecimateOptions options;
    options.goal = DecimateGoal::distance;
    options.weights.texcoord = 0.0;
    options.fit_positions = true;
    const auto distance = [&](const Mesh& mesh) {
        double sum = 0.0;
        std::size_t count = 0;
        for_each_sample(mesh, [&](const glm::dvec3& p, const glm::dvec2&) {
            sum += (glm::length(p) - 1.0) * (glm::length(p) - 1.0);
            ++count;
        });
        return std::sqrt(sum / static_cast<double>(count));
    };
    options.triangles = 800;
    const double fitted = distance(decimated(rough, options).mesh);
    options.fit_positions = false;
    const double unfitted = distance(decimated(rough, options).mesh);
    // With the planes of the rough triangles only, a similar sphere has 0.53.
    EXPECT_LT(fitted, 0.45 * unfitted);
}

// Quadrics alone, means over area, leave a vertex of the scan at 0.0081. A tenth of the triangles.
TEST(DecimateFit, KeepsTheLargestDistanceSmall) {
    RELIEF_NEEDS_SHARED(file, "data/dense/hammer.obj");
    const Mesh hammer = read_mesh(file).mesh;
    DecimateOptions options;
    options.goal = DecimateGoal::largest_distance;
    options.triangles = 6016;
    options.fit_positions = true;
    EXPECT_LT(largest_vertex_distance(hammer, decimated(hammer, options).mesh, 0.0), 0.0055);
    options.goal = DecimateGoal::distance;
    EXPECT_GT(largest_vertex_distance(hammer, decimated(hammer, options).mesh, 0.0), 0.0075);
}

TEST(DecimateFit, FlatFacesEdgesAndCornersDoNotMove) {
    DecimateOptions options;
    options.triangles = 24;
    options.fit_positions = true;
    Report report;
    for (const Mesh& mesh : {test::grid(12), test::cube()}) {
        const FramedMesh small = decimated(mesh, options, report);
        for (std::size_t v = 0; v < small.mesh.positions.size(); ++v) {
            EXPECT_LT(glm::length(small.mesh.positions[v] - mesh.positions[small.source_vertex[v]]),
                      1e-6F);
        }
    }
}

TEST(DecimateFit, KeptBordersAndTrianglesSetAsideDoNotMove) {
    Mesh hill = test::grid(24);
    for (glm::vec3& p : hill.positions)
        p.z = 0.5F * p.x * p.x - 0.3F * p.y * p.y;
    hill.normals.clear();
    // A triangle with a corner that is not finite, at a vertex inside.
    const std::uint32_t inside = 12 * 25 + 12;
    hill.positions.emplace_back(std::numeric_limits<float>::quiet_NaN());
    hill.texcoords.emplace_back(0.0F);
    hill.tangents.clear();
    hill.material_ranges.clear();
    hill.triangles.emplace_back(inside, inside + 1, hill.positions.size() - 1);
    DecimateOptions options;
    options.triangles = 150;
    options.fit_positions = true;
    options.keep_borders = true;
    Report report;
    const FramedMesh small = decimated(hill, options, report);
    std::size_t moved = 0;
    for (std::size_t v = 0; v < small.mesh.positions.size(); ++v) {
        const std::uint32_t source = small.source_vertex[v];
        const glm::vec3 before = hill.positions[source];
        if (small.mesh.positions[v] == before) continue;
        moved += std::isnan(before.x) ? 0 : 1;
        EXPECT_FALSE(source == inside || source == inside + 1);
        if (std::isnan(before.x)) continue;
        EXPECT_TRUE(before.x > 0.0F && before.x < 1.0F && before.y > 0.0F && before.y < 1.0F);
    }
    EXPECT_GT(moved, 10U);
}

TEST(DecimateFit, IsIndependentOfOrderAndThreads) {
    Mesh sphere = test::sphere(64, 32);
    DecimateOptions options;
    options.triangles = 300;
    options.fit_positions = true;
    const auto expected = triangle_positions(decimated(sphere, options).mesh);
    std::mt19937 random(6);
    for (const int threads : {1, 2}) {
        std::shuffle(sphere.triangles.begin(), sphere.triangles.end(), random);
        set_thread_limit(threads);
        EXPECT_EQ(triangle_positions(decimated(sphere, options).mesh), expected);
    }
    set_thread_limit(0);
}

}  // namespace
}  // namespace relief
