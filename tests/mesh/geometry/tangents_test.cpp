// SPDX-License-Identifier: Apache-2.0
// Tangents: hand-computed values, invariants for every hard mesh, changes that must not change the
// result, and shapes with a high worst-case cost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <numbers>

#include "geometry/tangent_groups.h"
#include "mesh/geometry/normal_samples.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/tangents.h"
#include "support/hard_meshes.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::detail;

namespace {

using test::degrees_between;
using test::float_degrees;
using testing::Each;

constexpr glm::vec4 along_x(1.0F, 0.0F, 0.0F, 1.0F);

using Method = decltype(&mikktspace_tangents);

constexpr Method all_methods[] = {mikktspace_tangents, area_weighted_tangents, lengyel_tangents};

std::vector<glm::vec4> tangents_of(const Mesh& mesh, Report& report,
                                   Method method = mikktspace_tangents) {
    return method(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, report);
}

std::vector<glm::vec4> tangents_of(const Mesh& mesh, Method method) {
    Report report;
    return tangents_of(mesh, report, method);
}

std::vector<glm::vec4> tangents_of(const Mesh& mesh) {
    Report report;
    return tangents_of(mesh, report);
}

TEST(Tangents, AnUprightTextureHasTangentsAlongUAndPositiveW) {
    // u runs along +x, and the image is upright: v runs along -y. So the bitangent, w * cross(n,
    // t), is +y: up.
    Report report;
    EXPECT_THAT(tangents_of(test::grid(3), report), Each(along_x));
    EXPECT_TRUE(report.empty());
}

TEST(Tangents, AMirroredTextureHasNegativeW) {
    Mesh mesh = test::grid(3);
    for (glm::vec2& texcoord : mesh.texcoords)
        texcoord.x = 1.0F - texcoord.x;
    EXPECT_THAT(tangents_of(mesh), Each(glm::vec4(-1, 0, 0, -1)));
}

TEST(Tangents, ATextureUpsideDownIsMirroredToo) {
    Mesh mesh = test::grid(3);
    for (glm::vec2& texcoord : mesh.texcoords)
        texcoord.y = 1.0F - texcoord.y;
    EXPECT_THAT(tangents_of(mesh), Each(glm::vec4(1, 0, 0, -1)));
}

TEST(Tangents, EachFaceOfACubeFollowsItsOwnTexture) {
    const Mesh cube = test::cube();
    const auto tangents = tangents_of(cube);
    const glm::vec3 rights[] = {{1, 0, 0}, {0, 0, -1}, {-1, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 0, 0}};
    for (std::size_t corner = 0; corner < tangents.size(); ++corner)
        EXPECT_EQ(tangents[corner], glm::vec4(rights[corner / 6], 1.0F));
}

TEST(Tangents, OnTheSphereTheyPointEast) {
    const Mesh sphere = test::sphere(64, 32);
    const auto tangents = tangents_of(sphere);
    for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
        const glm::dvec3 n(sphere.normals[test::vertex_at(sphere, corner)]);
        EXPECT_EQ(tangents[corner].w, 1.0F);
        if (std::abs(n.y) > 0.99) continue;  // East is undefined at a pole.
        // Seam vertices have triangles on one side only: the error is at most half a cell of 360/64
        // degrees.
        EXPECT_LE(degrees_between(tangents[corner], {n.z, 0.0, -n.x}), 3.0);
    }
}

TEST(Tangents, AverageByTheAngleOfTheCornerAsTheNormalSeesIt) {
    // Vertex 0 has a corner of 90 degrees whose u runs along x, and one of 45 degrees whose u is
    // rotated.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 1, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.texcoords = {{0, 0}, {1, 0}, {0, -1}, {-3, -1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    // In the second triangle, u = 3x with v up = y has a gradient along x. The third vertex rotates
    // it: v up = y + x there.
    mesh.texcoords[3] = {-1, -2};
    // In triangle 1, a step along y changes (u, v up) by (0,1), and a step along -x + y by (-1,2).
    // A step along -x changes it by (-1,1), so u alone grows along x + y.
    const auto tangents = tangents_of(mesh);
    const glm::dvec3 first(1, 0, 0);
    const glm::dvec3 second = glm::normalize(glm::dvec3(1, 1, 0));
    EXPECT_LE(degrees_between(tangents[0], 2.0 * first + second), float_degrees);
    EXPECT_EQ(tangents[0], tangents[3]);
    EXPECT_LE(degrees_between(tangents[1], first), float_degrees);
    EXPECT_LE(degrees_between(tangents[5], second), float_degrees);
    // At vertex 2: 45 degrees in the first triangle, 90 in the second.
    EXPECT_LE(degrees_between(tangents[2], first + 2.0 * second), float_degrees);
}

TEST(Tangents, AreAveragedInThePlaneOfTheNormal) {
    Mesh mesh = test::grid(1);
    for (glm::vec3& normal : mesh.normals)
        normal = {3, 0, 4};  // Neither unit nor perpendicular to the surface.
    for (const glm::vec4& tangent : tangents_of(mesh))
        EXPECT_LE(degrees_between(tangent, {4, 0, -3}), float_degrees);
}

TEST(Tangents, DifferAtMirroredSeams) {
    Mesh mesh = test::grid(2);
    for (glm::vec2& texcoord : mesh.texcoords)
        texcoord.x = std::abs(texcoord.x - 0.5F);
    const auto tangents = tangents_of(mesh);
    for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
        // Cells to the left of the middle are mirrored.
        const bool left = corner / 3 % 4 < 2;
        EXPECT_EQ(tangents[corner], left ? glm::vec4(-1, 0, 0, -1) : along_x);
    }
}

TEST(Tangents, KeepTheirHandednessAcrossMirroredSeams) {
    // All tangents are equal, so that only the sign separates the corners of a vertex in the
    // middle.
    Mesh mesh = test::grid(2);
    for (glm::vec2& texcoord : mesh.texcoords)
        texcoord.y = std::abs(texcoord.y - 0.5F);
    const auto tangents = tangents_of(mesh);
    for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
        const glm::uvec3& triangle = mesh.triangles[corner / 3];
        const float y = mesh.positions[triangle.x].y + mesh.positions[triangle.y].y +
                        mesh.positions[triangle.z].y;
        EXPECT_EQ(tangents[corner], glm::vec4(1, 0, 0, y > 1.5F ? -1 : 1)) << corner;
    }
}

TEST(Tangents, AreTheSameForSeveralCopiesOfAVertex) {
    Mesh mesh = test::grid(3);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.positions[i].z = 0.2F * std::sin(static_cast<float>(i));
    const auto expected = tangents_of(mesh);
    Mesh loose;  // Each triangle has three vertices, and half of the zeros are written as -0.
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t v = mesh.triangles[t][i];
            const float zero = t % 2 == 0 ? 0.0F : -0.0F;
            const auto copied = [&](float x) { return x == 0.0F ? zero : x; };
            const glm::vec3& p = mesh.positions[v];
            loose.positions.emplace_back(copied(p.x), copied(p.y), copied(p.z));
            loose.normals.emplace_back(zero, zero, 1.0F);
            loose.texcoords.emplace_back(copied(mesh.texcoords[v].x), copied(mesh.texcoords[v].y));
        }
        const auto first = static_cast<std::uint32_t>(3 * t);
        loose.triangles.emplace_back(first, first + 1, first + 2);
    }
    EXPECT_TRUE(test::same_bits(tangents_of(loose), expected));
}

TEST(Tangents, HoldTheInvariantsOnEveryHardMesh) {
    for (const test::NamedMesh& hard : test::hard_meshes()) {
        SCOPED_TRACE(hard.name);
        for (const Method method : all_methods)
            EXPECT_EQ(test::broken_tangents(hard.mesh, tangents_of(hard.mesh, method)), "");
    }
}

TEST(Tangents, PermutingTrianglesChangesNoBit) {
    std::vector<test::NamedMesh> meshes = test::hard_meshes();
    meshes.push_back({"sphere", test::sphere(20, 10)});
    for (const test::NamedMesh& hard : meshes) {
        SCOPED_TRACE(hard.name);
        const auto order = test::shuffled(hard.mesh.triangles.size());
        for (const Method method : all_methods) {
            const auto permuted = tangents_of(test::with_triangle_order(hard.mesh, order), method);
            const auto expected = test::corners_in_order(tangents_of(hard.mesh, method), order);
            EXPECT_TRUE(test::same_bits(permuted, expected));
        }
    }
}

TEST(Tangents, TheNumberOfThreadsChangesNoBit) {
    const Mesh sphere = test::sphere(200, 100);
    set_thread_limit(1);
    const auto expected = tangents_of(sphere);
    set_thread_limit(0);
    EXPECT_TRUE(test::same_bits(tangents_of(sphere), expected));
}

TEST(Tangents, TheScaleOfPositionsNormalsAndTextureChangesNothing) {
    Mesh mesh = test::grid(6);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.positions[i].z = 0.1F * std::sin(1.7F * static_cast<float>(i));
    const auto expected = tangents_of(mesh);
    // Powers of two up to the limits of their range, so that floats keep their digits.
    for (const int exponent : {-120, -60, -30, 30, 60, 120}) {
        SCOPED_TRACE(exponent);
        const float factor = std::ldexp(1.0F, exponent);
        Mesh scaled = mesh;
        for (glm::vec3& position : scaled.positions)
            position *= factor;
        EXPECT_TRUE(test::same_bits(tangents_of(scaled), expected)) << "positions";
        scaled = mesh;
        for (glm::vec3& normal : scaled.normals)
            normal *= factor;
        EXPECT_TRUE(test::same_bits(tangents_of(scaled), expected)) << "normals";
        scaled = mesh;
        for (glm::vec2& texcoord : scaled.texcoords)
            texcoord *= factor;
        EXPECT_TRUE(test::same_bits(tangents_of(scaled), expected)) << "texture";
    }
}

TEST(Tangents, OffsetOfTheTextureCostsOnlyFloatPrecision) {
    Mesh mesh = test::grid(8);  // Multiples of 1/8 stay exact at an offset of 2^20.
    const auto expected = tangents_of(mesh);
    for (glm::vec2& texcoord : mesh.texcoords)
        texcoord += 1048576.0F;
    EXPECT_TRUE(test::same_bits(tangents_of(mesh), expected));
}

TEST(Tangents, RotateWithTheMesh) {
    const glm::dmat3 rotation(0.6, 0.8, 0.0, -0.8, 0.6, 0.0, 0.0, 0.0, 1.0);
    Mesh mesh = test::grid(6);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.positions[i].z = 0.1F * std::sin(1.7F * static_cast<float>(i));
    Mesh rotated = mesh;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        rotated.positions[i] = rotation * glm::dvec3(mesh.positions[i]);
        rotated.normals[i] = rotation * glm::dvec3(mesh.normals[i]);
    }
    const auto before = tangents_of(mesh);
    const auto after = tangents_of(rotated);
    for (std::size_t corner = 0; corner < before.size(); ++corner) {
        EXPECT_EQ(after[corner].w, before[corner].w);
        // The rounding of positions near 1 is 6e-8 for edges of 1/6: 4e-7, or 2e-5 degrees.
        EXPECT_LE(degrees_between(after[corner], rotation * glm::dvec3(before[corner])), 1e-4);
    }
}

TEST(Tangents, TriangleWithoutGradientHasTheFramesOfItsNeighbors) {
    Mesh mesh = test::grid(2);
    // The last triangle, at the lower right, gets its own vertex and loses its texture.
    glm::uvec3& triangle = mesh.triangles.back();
    const std::uint32_t doubled = triangle.y;
    mesh.texcoords[doubled] = mesh.texcoords[triangle.x];
    Report report;
    const auto tangents = tangents_of(mesh, report);
    EXPECT_GE(report.count("triangle without texture gradient"), 1U);
    for (std::size_t corner = tangents.size() - 3; corner < tangents.size(); ++corner)
        EXPECT_EQ(tangents[corner].w, 1.0F);
    EXPECT_EQ(test::broken_tangents(mesh, tangents), "");
}

TEST(Tangents, TriangleWithoutGradientHasTheHandednessOfMostNeighbors) {
    for (int sides = 0; sides < 8; ++sides) {
        SCOPED_TRACE(sides);
        // The texture of the middle triangle is a line. The third corner of each neighbor lies
        // above or below it.
        Mesh mesh;
        mesh.positions = {{0, 0, 0}, {2, 0, 0}, {1, 2, 0}, {1, -1, 0}, {3, 2, 0}, {-1, 2, 0}};
        mesh.normals.assign(6, {0, 0, 1});
        mesh.texcoords = {{0, 0}, {1, 0}, {2, 0}};
        for (int i = 0; i < 3; ++i)
            mesh.texcoords.emplace_back(0.5F, (sides >> i & 1) != 0 ? 1.0F : -1.0F);
        mesh.triangles = {{0, 1, 2}, {1, 0, 3}, {2, 1, 4}, {0, 2, 5}};
        const auto tangents = tangents_of(mesh);
        const float sum = tangents[3].w + tangents[6].w + tangents[9].w;
        EXPECT_EQ(tangents[0].w, sum > 0.0F ? 1.0F : -1.0F);
        EXPECT_EQ(test::broken_tangents(mesh, tangents), "");
    }
}

TEST(Tangents, WithoutAnyTextureTheyFollowAFixedRuleAndAreCounted) {
    Mesh mesh = test::grid(1);
    mesh.texcoords.assign(4, {0.5F, 0.5F});
    mesh.normals = {{0, 0, 1}, {1, 0, 0}, {0, 0.6F, 0.8F}, {0.6F, 0, 0.8F}};
    Report report;
    const auto tangents = tangents_of(mesh, report);
    EXPECT_EQ(report.count("triangle without texture gradient"), 2U);
    EXPECT_EQ(report.count("corner without texture direction"), 6U);
    const glm::dvec3 expected[] = {{1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0.8, 0, -0.6}};
    for (std::size_t corner = 0; corner < 6; ++corner) {
        const std::uint32_t vertex = test::vertex_at(mesh, corner);
        EXPECT_LE(degrees_between(tangents[corner], expected[vertex]), float_degrees);
        EXPECT_EQ(tangents[corner].w, -1.0F);
    }
}

TEST(Tangents, CollapsedTriangleHasTheFramesOfItsVertices) {
    Mesh mesh = test::grid(1);
    mesh.triangles.emplace_back(0, 0, 3);
    Report report;
    const auto tangents = tangents_of(mesh, report);
    EXPECT_EQ(report.count("triangle with coinciding corners"), 1U);
    EXPECT_EQ(report.findings().size(), 1U);
    EXPECT_THAT(tangents, Each(along_x));
}

TEST(Tangents, ADegenerateTriangleBetweenTwoHandednessesHasOneW) {
    // Two mirrored cells, and a triangle that joins a corner of the left one with two of the right
    // one.
    Mesh mesh = test::grid(1);
    Mesh other = test::grid(1);
    for (std::size_t i = 0; i < 4; ++i) {
        mesh.positions.push_back(other.positions[i] + glm::vec3(3, 0, 0));
        mesh.normals.push_back(other.normals[i]);
        mesh.texcoords.emplace_back(1.0F - other.texcoords[i].x, other.texcoords[i].y);
    }
    for (const glm::uvec3& triangle : other.triangles)
        mesh.triangles.push_back(triangle + 4U);
    mesh.triangles.emplace_back(0, 4, 4);
    mesh.triangles.emplace_back(0, 0, 4);
    const auto tangents = tangents_of(mesh);
    for (std::size_t corner = 12; corner < 15; ++corner)
        EXPECT_EQ(tangents[corner].w, -1.0F) << "two of three vertices are mirrored";
    for (std::size_t corner = 15; corner < 18; ++corner)
        EXPECT_EQ(tangents[corner].w, 1.0F);
    EXPECT_EQ(glm::vec3(tangents[12]), glm::vec3(1, 0, 0));
    EXPECT_EQ(glm::vec3(tangents[13]), glm::vec3(-1, 0, 0));
}

TEST(Tangents, NonFiniteValuesStayAtTheirOwnTriangles) {
    const Mesh clean = test::grid(4);
    const auto expected = tangents_of(clean);
    for (int kind = 0; kind < 3; ++kind) {
        SCOPED_TRACE(kind);
        Mesh mesh = clean;
        const float bad = std::numeric_limits<float>::quiet_NaN();
        if (kind == 0) mesh.positions[12].x = bad;
        if (kind == 1) mesh.texcoords[12].y = bad;
        if (kind == 2) mesh.normals[12].z = bad;
        Report report;
        const auto tangents = tangents_of(mesh, report);
        EXPECT_EQ(test::broken_tangents(mesh, tangents), "");
        EXPECT_EQ(report.count("triangle with non-finite values"), kind < 2 ? 6U : 0U);
        EXPECT_EQ(report.count("normal without direction"), kind < 2 ? 0U : 1U);
        for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
            const std::uint32_t vertex = test::vertex_at(mesh, corner);
            if (vertex == 12) continue;
            EXPECT_EQ(tangents[corner], expected[corner]) << "corner " << corner;
        }
    }
}

/// Two perpendicular squares of 10 by 10 with a bevel of 0.1 between them. Normals are smooth over
/// the bevel, and its texture is rotated by 45 degrees.
Mesh bevelled() {
    Mesh mesh;
    const glm::vec3 up(0, 0, 1), slanted = glm::normalize(glm::vec3(1, 0, 1));
    const auto quad = [&](const std::array<glm::vec3, 4>& corners, const glm::vec3& normal,
                          const std::array<glm::vec2, 4>& texcoords) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
        mesh.normals.insert(mesh.normals.end(), 4, normal);
        mesh.texcoords.insert(mesh.texcoords.end(), texcoords.begin(), texcoords.end());
        mesh.triangles.emplace_back(first, first + 1, first + 2);
        mesh.triangles.emplace_back(first, first + 2, first + 3);
    };
    // The large face has the shared normal at its edge to the bevel, so that they are neighbors.
    quad({{{-10, 0, 0}, {0, 0, 0}, {0, 10, 0}, {-10, 10, 0}}}, up,
         {{{0, 0}, {1, 0}, {1, -1}, {0, -1}}});
    quad({{{0, 0, 0}, {0.1F, 0, -0.1F}, {0.1F, 10, -0.1F}, {0, 10, 0}}}, slanted,
         {{{1, 0}, {1.01F, -0.01F}, {1.01F, -1.01F}, {1, -1}}});
    mesh.normals[4] = mesh.normals[7] = up;
    return mesh;
}

TEST(Tangents, AreaWeightsLeaveALargeFaceUndisturbedByAThinBevel) {
    const Mesh mesh = bevelled();
    const auto by_angle = tangents_of(mesh);
    const auto by_area = tangents_of(mesh, area_weighted_tangents);
    // Corner 1 of triangle 0 is at the bevel. On the bevel, u runs 0.1 along the slope for each 0.1
    // in y: from above, 45 degrees.
    const double disturbed = degrees_between(by_angle[1], {1, 0, 0});
    const double undisturbed = degrees_between(by_area[1], {1, 0, 0});
    EXPECT_GT(disturbed, 5.0);
    // Areas of 50 against two triangles of 0.7 in total.
    EXPECT_LT(undisturbed, 1.5);
    EXPECT_GT(undisturbed, 0.0) << "but they are averaged";
}

TEST(Tangents, LengyelSumsGradientsOfAllTrianglesAtAVertex) {
    // Two triangles that share only vertex 0. The texture of the second one has 3 times the
    // stretch, and its u runs along y.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {-1, 0, 0}};
    mesh.positions[3] *= 3.0F;
    mesh.normals.assign(5, {0, 0, 1});
    mesh.texcoords = {{0, 0}, {1, 0}, {0, -1}, {-1, 0}, {0, -1}};
    mesh.triangles = {{0, 1, 2}, {0, 4, 3}};
    const auto tangents = tangents_of(mesh, lengyel_tangents);
    EXPECT_EQ(tangents[0], tangents[3]);
    EXPECT_LE(degrees_between(tangents[0], {1, 3, 0}), float_degrees);
    EXPECT_EQ(tangents[0].w, 1.0F);
    EXPECT_NE(tangents_of(mesh)[0], tangents_of(mesh)[3]) << "which are no neighbors";
}

TEST(Tangents, LengyelsKeepHandednessesApart) {
    Mesh mesh = test::grid(2);
    for (glm::vec2& texcoord : mesh.texcoords)
        texcoord.x = std::abs(texcoord.x - 0.5F);
    EXPECT_EQ(tangents_of(mesh, lengyel_tangents), tangents_of(mesh));
}

TEST(Tangents, ATriangleOnALineInSpaceKeepsItsTexturesDirection) {
    // Its corners have no angle or area and count for nothing. A mirrored texture puts it alone
    // into a group, where it is the only contribution.
    Mesh mesh = test::grid(1);
    mesh.positions.emplace_back(0.5F, 0.5F, 0.0F);
    mesh.normals.emplace_back(0, 0, 1);
    mesh.texcoords.emplace_back(0.9F, 0.3F);
    const std::uint32_t upper_left = 0;
    const std::uint32_t lower_right = 3;
    ASSERT_EQ(mesh.positions[upper_left] + mesh.positions[lower_right],
              2.0F * mesh.positions.back());
    mesh.triangles.emplace_back(lower_right, upper_left, 4);
    for (const Method method : all_methods) {
        Report report;
        const auto tangents = tangents_of(mesh, report, method);
        EXPECT_TRUE(report.empty()) << report.findings().front().kind;
        EXPECT_EQ(test::broken_tangents(mesh, tangents), "");
        for (std::size_t corner = 0; corner < 6; ++corner)
            EXPECT_EQ(tangents[corner], along_x);
        const glm::dvec3 diagonal(mesh.positions[lower_right] - mesh.positions[upper_left]);
        for (std::size_t corner = 6; corner < 9; ++corner) {
            const glm::dvec3 tangent(tangents[corner]);
            EXPECT_LE(
                std::min(degrees_between(tangent, diagonal), degrees_between(tangent, -diagonal)),
                float_degrees);
        }
        EXPECT_EQ(tangents[6], tangents[7]);
    }
}

TEST(Tangents, ATextureThatRunsAlongTheNormalIsCounted) {
    Mesh mesh = test::grid(2);
    // At the middle vertex, u runs along the normal, and its neighbors have no other direction.
    mesh.normals[4] = {1, 0, 0};
    Report report;
    const auto tangents = tangents_of(mesh, report);
    EXPECT_EQ(report.count("texture direction along the normal"), 6U);
    EXPECT_EQ(report.count("corner without texture direction"), 6U);
    EXPECT_EQ(test::broken_tangents(mesh, tangents), "");
}

TEST(Tangents, ZeroNormalsLeaveTheTextureDirection) {
    Mesh mesh = test::grid(2);
    mesh.normals.assign(mesh.normals.size(), glm::vec3(0.0F));
    Report report;
    EXPECT_THAT(tangents_of(mesh, report), Each(along_x));
    EXPECT_EQ(report.count("normal without direction"), 9U);
}

TEST(Tangents, CanceledSumsUseTheTriangleOfEachCorner) {
    // A fan of a quarter turn whose u runs around the apex: the average there is zero.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}};
    mesh.normals.assign(6, {0, 0, 1});
    mesh.texcoords = {{0.5F, 0}, {0, 1}, {0.25F, 1}, {0.5F, 1}, {0.75F, 1}, {1, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
    const auto tangents = tangents_of(mesh);
    const glm::dvec3 around[] = {{-1, 0, 0}, {0, -1, 0}, {1, 0, 0}, {0, 1, 0}};
    for (std::size_t t = 0; t < 4; ++t)
        EXPECT_LE(degrees_between(tangents[3 * t], around[t]), float_degrees);
}

TEST(Tangents, ARepeatedTriangleCountsOnceAndIsCounted) {
    Mesh mesh = test::grid(2);
    const auto expected = tangents_of(mesh);
    mesh.positions[4].z = 0.3F;
    const auto once = tangents_of(mesh);
    const glm::uvec3 triangle = mesh.triangles[3];
    mesh.triangles.push_back(triangle);
    mesh.triangles.emplace_back(triangle.z, triangle.x, triangle.y);
    Report report;
    const auto tangents = tangents_of(mesh, report);
    EXPECT_EQ(report.count("repeated triangle"), 2U);
    for (std::size_t corner = 0; corner < once.size(); ++corner)
        EXPECT_EQ(tangents[corner], once[corner]);
    EXPECT_EQ(tangents[24], once[9]);
    EXPECT_EQ(tangents[27], once[11]);
}

TEST(Tangents, OfAnEmptyMeshAreEmpty) {
    EXPECT_TRUE(tangents_of(Mesh{}).empty());
}

TEST(Tangents, WrongLengthsAndIndicesAreRefused) {
    Report report;
    Mesh mesh = test::grid(1);
    mesh.normals.pop_back();
    EXPECT_THAT([&] { tangents_of(mesh, report); },
                testing::ThrowsMessage<InvalidInput>(
                    testing::StrEq("there are 3 normals, but 4 positions")));
    mesh = test::grid(1);
    mesh.texcoords.clear();
    EXPECT_THAT([&] { tangents_of(mesh, report); },
                testing::ThrowsMessage<InvalidInput>(
                    testing::StrEq("there are 0 texture coordinates, but 4 positions")));
    mesh = test::grid(1);
    mesh.triangles[1].x = 4;
    EXPECT_THAT([&] { tangents_of(mesh, report); },
                testing::ThrowsMessage<InvalidInput>(
                    testing::StrEq("triangle 1 names vertex 4, but there are only 4")));
}

/// Shapes for which a search for neighbors, recursion or comparison of sets takes quadratic time.
Mesh crowded(int kind, std::uint32_t count) {
    Mesh mesh;
    const auto add = [&](glm::vec3 position, glm::vec2 texcoord) {
        mesh.positions.push_back(position);
        mesh.texcoords.push_back(texcoord);
        mesh.normals.emplace_back(0, 0, 1);
    };
    add({0, 0, 0}, {0.5F, 0.5F});
    add({1, 0, 0}, {1, 0.5F});
    for (std::uint32_t i = 0; i < count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / count;
        const glm::dvec2 circle(std::cos(angle), std::sin(angle));
        if (kind < 2)
            add({circle, 0}, kind == 0 ? glm::dvec2(0.5) + 0.5 * circle : glm::dvec2(angle, 1));
        if (kind == 2) add({circle, 1 + i % 7}, {0.1 * (i % 10), 0.1 * (i % 9)});
        if (kind == 3) add({circle.x, 0, 0}, circle);
        if (kind == 4) add({0, 0, 0}, circle);
        const std::uint32_t next = (i + 1) % count + 2;
        if (kind == 2) {
            mesh.triangles.emplace_back(i % 2, 1 - i % 2, i + 2);
        } else {
            mesh.triangles.emplace_back(0, i + 2, next);
        }
    }
    return mesh;
}

TEST_LABELS(not_sanitized);
TEST(Tangents, AreLinearForAllShapes) {
    const char* const names[] = {"flat fan", "fan with a texture around it", "one edge", "line",
                                 "point"};
    for (int kind = 0; kind < 5; ++kind) {
        SCOPED_TRACE(names[kind]);
        // Eight times as many triangles take eight times as long in linear time, and 64 times in
        // quadratic time. The least of three is compared, because other programs change times.
        constexpr std::uint32_t small = 12500;
        double of_small = 1e9;
        double of_large = 1e9;
        for (const std::uint32_t size : {small, small, small, 8 * small, 8 * small, 8 * small}) {
            const Mesh mesh = crowded(kind, size);
            const std::clock_t start = std::clock();
            const auto tangents = tangents_of(mesh);
            double& least = size == small ? of_small : of_large;
            least = std::min(least, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
            EXPECT_EQ(test::broken_tangents(mesh, tangents), "");
        }
        EXPECT_LT(of_large, 24.0 * of_small);
    }
}

constexpr glm::dvec3 along_z(0.0, 0.0, 1.0);

/// The value of a contribution of length 1 in sums.
constexpr double unit_in_sums = 1 << 20;

TangentSum contribution(const glm::dvec3& vector) {
    const auto at = [&](double number) { return std::llround(unit_in_sums * number); };
    return {at(vector.x), at(vector.y), at(vector.z), at(glm::length(vector))};
}

/// A term with this u, and v at a right angle to it.
SidedTerm member(const glm::vec3& u, double weight = 1.0) {
    return {contribution(weight * glm::dvec3(u)), u, glm::vec3(-u.y, u.x, 0.0F)};
}

TEST(OppositeTangents, AnOppositeMemberIsLeftOutOfEachOthersSum) {
    const std::vector<SidedTerm> members = {member({1, 0, 0}), member({-1, 0, 0}, 0.5),
                                            member({0, 1, 0}, 0.25)};
    const std::vector<TangentSum> sums = sums_without_opposites(members, along_z);
    EXPECT_EQ(sums[0].vector(), unit_in_sums * glm::dvec3(1.0, 0.25, 0.0));
    EXPECT_EQ(sums[1].vector(), unit_in_sums * glm::dvec3(-0.5, 0.25, 0.0));
    EXPECT_EQ(sums[2].vector(), unit_in_sums * glm::dvec3(0.5, 0.25, 0.0));
}

TEST(OppositeTangents, OppositeInVAloneIsEnough) {
    std::vector<SidedTerm> members = {member({1, 0, 0}), member({1, 0, 0})};
    members[1].along_v = -members[0].along_v;
    for (const TangentSum& sum : sums_without_opposites(members, along_z))
        EXPECT_EQ(sum.vector(), unit_in_sums * glm::dvec3(1.0, 0.0, 0.0));
}

TEST(OppositeTangents, MemberWithoutDirectionIsIgnored) {
    const std::vector<SidedTerm> members = {member({1, 0, 0}), member({0, 0, 0})};
    for (const TangentSum& sum : sums_without_opposites(members, along_z))
        EXPECT_EQ(sum.vector(), unit_in_sums * glm::dvec3(1.0, 0.0, 0.0));
}

TEST(OppositeTangents, ManyMembersGiveTheSameAsFew) {
    // 200 members in 8 directions, 45 degrees apart: each one lacks the 25 of the opposite
    // direction.
    std::vector<SidedTerm> members;
    TangentSum all;
    for (int i = 0; i < 200; ++i) {
        const double angle = std::numbers::pi / 4.0 * (i % 8) + 0.3;
        members.push_back(member({std::cos(angle), std::sin(angle), 0.0}, 1.0 + i % 8));
        all += members.back().term;
    }
    const std::vector<TangentSum> sums = sums_without_opposites(members, along_z);
    for (std::size_t i = 0; i < 200; ++i) {
        TangentSum expected = all;
        for (int opposite = 0; opposite < 25; ++opposite)
            expected -= members[(i + 4) % 8].term;
        EXPECT_EQ(sums[i], expected) << "member " << i;
    }
}

TEST(OppositeTangents, TheOrderOfMembersChangesNoBit) {
    std::vector<SidedTerm> members;
    for (int i = 0; i < 300; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 300.0;
        members.push_back(member({std::cos(angle), std::sin(angle), 0.0}, 1.0 / (1.0 + i)));
    }
    const std::vector<TangentSum> forward = sums_without_opposites(members, along_z);
    std::reverse(members.begin(), members.end());
    const std::vector<TangentSum> backward = sums_without_opposites(members, along_z);
    for (std::size_t i = 0; i < 300; ++i)
        EXPECT_EQ(forward[i], backward[299 - i]);
}

}  // namespace
}  // namespace relief
