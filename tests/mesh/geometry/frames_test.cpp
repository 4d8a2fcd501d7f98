// SPDX-License-Identifier: Apache-2.0
// Tangent frames of a whole mesh: normals, tangents and split vertices.
#include "relief/mesh/frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "relief/mesh/execution.h"
#include "relief/mesh/report.h"
#include "relief/mesh/tangents.h"
#include "support/hard_meshes.h"
#include "support/invariants.h"
#include "support/shapes.h"

namespace relief {
namespace {

using testing::StrEq;
using testing::ThrowsMessage;

FramedMesh framed(const Mesh& mesh, const FrameOptions& options) {
    Report report;
    return with_frames(mesh, options, report);
}

FrameOptions with_tangents(NormalMode normals) {
    return {normals, NormalWeight::angle, TangentMethod::mikktspace};
}

/// Checks the properties of every result: it is valid, its sources are in range, and the input
/// vertices come first and unchanged.
void expect_carried(const Mesh& before, const FramedMesh& after) {
    EXPECT_NO_THROW(validate(after.mesh));
    ASSERT_EQ(after.source_vertex.size(), after.mesh.positions.size());
    ASSERT_EQ(after.mesh.triangles.size(), before.triangles.size());
    for (std::size_t v = 0; v < after.source_vertex.size(); ++v) {
        const std::uint32_t source = after.source_vertex[v];
        if (v < before.positions.size()) {
            ASSERT_EQ(source, v);
        }
        ASSERT_TRUE(test::same_bits(std::vector{after.mesh.positions[v]},
                                    std::vector{before.positions[source]}));
    }
    for (std::size_t t = 0; t < before.triangles.size(); ++t) {
        for (int i = 0; i < 3; ++i)
            ASSERT_EQ(after.source_vertex[after.mesh.triangles[t][i]], before.triangles[t][i]);
    }
}

TEST(Frames, KeptNormalsPassThroughBitForBit) {
    Mesh mesh = test::grid(2);
    mesh.normals[0] = {-0.0F, 0.0F, 1.0F};
    mesh.normals[1] = {0.0F, 0.0F, 3.0F};
    mesh.normals[2] = {std::nanf("7"), 0.0F, 1.0F};
    mesh.tangents.assign(9, {1, 0, 0, -1});
    Report report;
    const FramedMesh result = with_frames(mesh, {}, report);
    EXPECT_TRUE(test::same_bits(result.mesh.normals, mesh.normals));
    EXPECT_TRUE(test::same_bits(result.mesh.tangents, mesh.tangents));
    EXPECT_EQ(result.mesh.triangles, mesh.triangles);
    EXPECT_EQ(report.count("normal not of unit length"), 1U);
    EXPECT_EQ(report.count("non-finite normal"), 1U);
}

TEST(Frames, NormalsFromEightBitsCountAsUnit) {
    Mesh mesh = test::grid(1);
    mesh.normals.assign(4, glm::round(glm::normalize(glm::vec3(1, 2, 3)) * 127.0F) / 127.0F);
    Report report;
    with_frames(mesh, {}, report);
    EXPECT_TRUE(report.empty());
}

TEST(Frames, MissingNormalsAreMadeAsAsked) {
    Mesh mesh = test::cube();
    mesh.normals.clear();
    const FramedMesh smooth =
        framed(mesh, {NormalMode::keep, NormalWeight::angle, TangentMethod::keep});
    const FramedMesh flat = framed(mesh, {NormalMode::keep, NormalMode::flat, TangentMethod::keep});
    for (std::size_t v = 0; v < 24; ++v) {
        EXPECT_LE(test::degrees_between(smooth.mesh.normals[v], mesh.positions[v]), 4e-6);
        EXPECT_EQ(flat.mesh.normals[v], test::cube().normals[v]);
    }
}

TEST(Frames, FlatNormalsSplitOnlyBentEdges) {
    Mesh cube = test::cube();
    EXPECT_EQ(framed(cube, {NormalMode::flat}).mesh.positions.size(), 24U);
    // A roof: four vertices in a plane and two beyond the ridge. Only the ridge is split.
    Mesh roof;
    roof.positions = {{0, 0, 0},  {0, 1, 0},  {-1, 1, 0}, {-1, 0, 0},
                      {1, 1, -1}, {1, 0, -1}, {9, 9, 9}};
    roof.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 5, 4}, {0, 4, 1}};
    Report report;
    const FramedMesh result = with_frames(roof, {NormalMode::flat}, report);
    expect_carried(roof, result);
    EXPECT_EQ(result.mesh.positions.size(), 9U);
    for (std::size_t t = 0; t < 4; ++t) {
        const glm::dvec3 expected = t < 2 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 1);
        for (int i = 0; i < 3; ++i) {
            const glm::vec3& normal = result.mesh.normals[result.mesh.triangles[t][i]];
            EXPECT_LE(test::degrees_between(normal, expected), 4e-6);
        }
    }
    EXPECT_EQ(result.mesh.normals[6], glm::vec3(0, 0, 1));
    EXPECT_EQ(report.count("isolated vertex"), 1U);
}

/// Two squares that share an edge. One is rotated up by 60 degrees.
Mesh folded_sheet() {
    Mesh mesh;
    mesh.positions = {{-1, 0, 0},        {0, 0, 0}, {0.5F, 0, 0.8660254F},
                      {-1, 1, 0},        {0, 1, 0}, {0.5F, 1, 0.8660254F},
                      {7.0F, 7.0F, 7.0F}};
    mesh.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
    return mesh;
}

TEST(Frames, ACreaseSplitsVerticesAlongSharperEdgesAlone) {
    Report report;
    FrameOptions options{NormalWeight::max};
    options.crease_angle = 1.0;
    const FramedMesh hard = with_frames(folded_sheet(), options, report);
    expect_carried(folded_sheet(), hard);
    EXPECT_EQ(hard.mesh.positions.size(), 9U);
    EXPECT_EQ(report.count("isolated vertex"), 1U);
    EXPECT_EQ(report.findings().size(), 1U);
    options.crease_angle = 1.1;
    EXPECT_EQ(framed(folded_sheet(), options).mesh.positions.size(), 7U);
    EXPECT_EQ(framed(folded_sheet(), {NormalWeight::max}).mesh.positions.size(), 7U);
}

TEST(Frames, SmoothingGroupsApplyUnlessDisabled) {
    Mesh mesh = folded_sheet();
    mesh.smoothing_groups = {1, 1, 0, 0};
    FrameOptions options{NormalMode::automatic};
    const FramedMesh followed = framed(mesh, options);
    EXPECT_EQ(followed.mesh.positions.size(), 9U);
    EXPECT_TRUE(followed.within_smoothing_groups);
    EXPECT_EQ(followed.mesh.smoothing_groups, mesh.smoothing_groups);
    options.smoothing_groups = false;
    EXPECT_EQ(framed(mesh, options).mesh.positions.size(), 7U);
    EXPECT_FALSE(framed(mesh, options).within_smoothing_groups);
    options.smoothing_groups = true;
    mesh.smoothing_groups.assign(4, 0);
    EXPECT_EQ(framed(mesh, options).mesh.positions.size(), 7U);
    mesh.smoothing_groups.assign(3, 1);
    EXPECT_THROW(framed(mesh, options), InvalidInput);
}

TEST(Frames, EveryWeightingHasItsMode) {
    // Corners of 45 and 90 degrees with edges of 1, 1.41 and 2: each weighting has another mean.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {0, 0, -2}};
    mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
    std::vector<double> slopes;
    for (const NormalMode mode :
         {NormalWeight::uniform, NormalWeight::area, NormalWeight::angle, NormalWeight::sine,
          NormalWeight::max, NormalWeight::angle_edges, NormalWeight::area_angle}) {
        const glm::vec3 normal = framed(mesh, {mode}).mesh.normals[0];
        slopes.push_back(normal.x / normal.z);
    }
    const double root = std::sqrt(2.0);
    const std::vector<double> expected = {1.0, 2.0, 2.0, root, 1.0, 2.0 * 2.0 / root, 4.0};
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_NEAR(slopes[i], expected[i], 1e-6) << i;
}

TEST(Frames, RepairTouchesOnlyBrokenNormals) {
    Mesh mesh = test::grid(1);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    mesh.normals = {{0, 0, 2}, {0.001F, 0, 1}, {nan, 0, 0}, {0, 0, 0}};
    FrameOptions options;
    options.repair = true;
    Report report;
    const FramedMesh repaired = with_frames(mesh, options, report);
    EXPECT_EQ(repaired.mesh.normals[0], glm::vec3(0, 0, 1));
    EXPECT_EQ(repaired.mesh.normals[1], mesh.normals[1]) << "within what 8 bits leave";
    EXPECT_EQ(repaired.mesh.normals[2], glm::vec3(0, 0, 1));
    EXPECT_EQ(repaired.mesh.normals[3], glm::vec3(0, 0, 1));
    ASSERT_EQ(report.findings().size(), 3U);
    EXPECT_EQ(report.findings()[0],
              (Finding{"normal not of unit length", "vertex", "scaled", 1, {0}}));
    EXPECT_EQ(report.findings()[1],
              (Finding{"non-finite normal", "vertex", "averaged again", 1, {2}}));
    EXPECT_EQ(report.findings()[2], (Finding{"zero normal", "vertex", "averaged again", 1, {3}}));
}

TEST(Frames, ComputedNormalsReplaceTheTangentsMadeForOthers) {
    Mesh mesh = test::grid(1);
    mesh.tangents.assign(4, {0, 1, 0, -1});  // It differs from the tangent of the texture.
    const std::vector<glm::vec4> along_u(4, {1, 0, 0, 1});
    EXPECT_EQ(framed(mesh, {NormalWeight::area}).mesh.tangents, along_u);
    EXPECT_EQ(framed(mesh, {}).mesh.tangents, mesh.tangents) << "kept with the normals";
    EXPECT_TRUE(framed(mesh, {NormalMode::keep, NormalWeight::angle, TangentMethod::none})
                    .mesh.tangents.empty());
    mesh.normals.clear();
    EXPECT_EQ(framed(mesh, {}).mesh.tangents, along_u) << "tangents without normals";
}

TEST(Frames, TangentsOfOtherNormalsWithoutTextureCoordinatesAreRemovedAndCounted) {
    Mesh mesh = test::grid(1);
    mesh.tangents.assign(4, {1, 0, 0, 1});
    mesh.texcoords.clear();
    Report report;
    EXPECT_TRUE(with_frames(mesh, {NormalWeight::area}, report).mesh.tangents.empty());
    EXPECT_EQ(report.count("tangents of other normals"), 1U);
}

TEST(Frames, TangentsReplaceThoseOfTheInput) {
    Mesh mesh = test::grid(2);
    mesh.tangents.assign(9, {0, 1, 0, -1});
    const FramedMesh result = framed(mesh, with_tangents(NormalMode::keep));
    EXPECT_THAT(result.mesh.tangents, testing::Each(glm::vec4(1, 0, 0, 1)));
    EXPECT_EQ(result.mesh.positions.size(), 9U);
}

TEST(Frames, AMirroredTextureSplitsTheVerticesOfItsAxisAndNoOther) {
    Mesh mesh = test::grid(4);
    for (glm::vec2& texcoord : mesh.texcoords)
        texcoord.x = std::abs(texcoord.x - 0.5F);
    const FramedMesh result = framed(mesh, with_tangents(NormalMode::keep));
    expect_carried(mesh, result);
    ASSERT_EQ(result.mesh.positions.size(), 25U + 5U);
    for (std::size_t copy = 25; copy < 30; ++copy)
        EXPECT_EQ(mesh.positions[result.source_vertex[copy]].x, 0.5F);
    for (const glm::uvec3& triangle : result.mesh.triangles) {
        const float w = result.mesh.tangents[triangle.x].w;
        EXPECT_EQ(result.mesh.tangents[triangle.y].w, w);
        EXPECT_EQ(result.mesh.tangents[triangle.z].w, w);
    }
}

TEST(Frames, AnIsolatedVertexStillHasAFrame) {
    Mesh mesh = test::grid(1);
    mesh.positions.emplace_back(7, 7, 7);
    mesh.normals.emplace_back(1, 0, 0);
    mesh.texcoords.emplace_back(0, 0);
    Report report;
    const FramedMesh result = with_frames(mesh, with_tangents(NormalMode::keep), report);
    EXPECT_EQ(result.mesh.tangents.back(), glm::vec4(0, 1, 0, -1));
    EXPECT_EQ(report.count("tangent of an isolated vertex"), 1U);
}

TEST(Frames, EveryHardMeshComesOutUsable) {
    for (const test::NamedMesh& hard : test::hard_meshes()) {
        SCOPED_TRACE(hard.name);
        for (const NormalMode mode : std::initializer_list<NormalMode>{
                 NormalMode::keep, NormalMode::flat, NormalWeight::area, NormalWeight::angle}) {
            const FramedMesh result = framed(hard.mesh, with_tangents(mode));
            expect_carried(hard.mesh, result);
            std::vector<glm::vec4> at_corners;
            for (const glm::uvec3& triangle : result.mesh.triangles) {
                for (int i = 0; i < 3; ++i)
                    at_corners.push_back(result.mesh.tangents[triangle[i]]);
            }
            EXPECT_EQ(test::broken_tangents(result.mesh, at_corners), "");
        }
    }
}

TEST(Frames, TheOrderOfTrianglesChangesNoVertex) {
    const Mesh mesh = test::sphere(16, 8);
    const auto order = test::shuffled(mesh.triangles.size());
    for (const NormalMode mode : {NormalMode::flat, NormalMode(NormalWeight::angle)}) {
        const FramedMesh one = framed(mesh, with_tangents(mode));
        const FramedMesh other =
            framed(test::with_triangle_order(mesh, order), with_tangents(mode));
        EXPECT_EQ(other.source_vertex, one.source_vertex);
        EXPECT_TRUE(test::same_bits(other.mesh.normals, one.mesh.normals));
        EXPECT_TRUE(test::same_bits(other.mesh.tangents, one.mesh.tangents));
    }
}

/// Returns a grid of several slices of triangles, with vertices that are not usual in each of them.
Mesh grid_with_hard_places() {
    Mesh mesh = test::grid(120);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        glm::vec2& texcoord = mesh.texcoords[v];
        if (v % 97 == 0) texcoord.y = 0.5F;  // Skewed or mirrored triangles.
        if (v % 121 > 90) texcoord.x = 1.5F - texcoord.x;
    }
    const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
    for (std::uint32_t t = 5; t < count; t += 997) {
        glm::uvec3& triangle = mesh.triangles[t];
        if (t % 3 == 0)
            triangle.y = triangle.x;
        else if (t % 3 == 1)
            mesh.triangles.push_back(triangle);
        else
            mesh.texcoords[triangle.z] = mesh.texcoords[triangle.x];
    }
    // Triangles with vertices in distant slices, a vertex that is not finite, one of many
    // triangles, and an isolated one.
    mesh.triangles.emplace_back(3, 14000, 7200);
    mesh.positions[5000].x = std::numeric_limits<float>::quiet_NaN();
    for (std::uint32_t i = 0; i < 20; ++i)
        mesh.triangles.emplace_back(9000, 9300 + 2 * i, 9301 + 2 * i);
    mesh.normals[8000] = glm::vec3(0.0F);
    mesh.positions.emplace_back(7, 7, 7);
    mesh.normals.emplace_back(1, 0, 0);
    mesh.texcoords.emplace_back(0, 0);
    return mesh;
}

TEST(Frames, TangentsByVertexAreThoseOfCorners) {
    const Mesh mesh = grid_with_hard_places();
    Report by_corner_report;
    const std::vector<glm::vec4> at_corners = mikktspace_tangents(
        mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, by_corner_report);
    for (const int threads : {1, 3}) {
        SCOPED_TRACE(threads);
        set_thread_limit(threads);
        Report report;
        const FramedMesh result = with_frames(mesh, with_tangents(NormalMode::keep), report);
        set_thread_limit(0);
        std::vector<glm::vec4> of_vertices;
        std::vector<glm::vec4> expected;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            for (int i = 0; i < 3; ++i) {
                of_vertices.push_back(result.mesh.tangents[result.mesh.triangles[t][i]]);
                expected.push_back(at_corners[3 * t + static_cast<std::size_t>(i)] + 0.0F);
            }
        }
        EXPECT_TRUE(test::same_bits(of_vertices, expected));
        expect_carried(mesh, result);
        EXPECT_EQ(result.mesh.tangents[mesh.positions.size() - 1], glm::vec4(0, 1, 0, -1));
        EXPECT_GT(result.mesh.positions.size(), mesh.positions.size() + 121);
        for (const Finding& finding : by_corner_report.findings())
            EXPECT_THAT(report.findings(), testing::Contains(finding)) << to_string(finding);
    }
    EXPECT_GT(by_corner_report.count("repeated triangle"), 5U);
    EXPECT_GT(by_corner_report.count("triangle with coinciding corners"), 5U);
    EXPECT_GT(by_corner_report.count("triangle without texture gradient"), 5U);
    EXPECT_GT(by_corner_report.count("triangle with non-finite values"), 0U);
}

TEST(Frames, RefusesImpossibleRequests) {
    Mesh mesh = test::grid(1);
    EXPECT_THAT(
        [&] {
            framed(mesh, {NormalMode::keep, NormalMode::keep});
        },
        ThrowsMessage<InvalidInput>(
            StrEq("normals that are missing cannot be kept: if_missing must name a mode")));
    EXPECT_THAT([&] { framed(mesh, {.tangents = TangentMethod::triangle}); },
                ThrowsMessage<InvalidInput>(
                    StrEq("tangents of single triangles can be identified, but not computed")));
    mesh.texcoords.clear();
    EXPECT_THAT([&] { framed(mesh, with_tangents(NormalMode::keep)); },
                ThrowsMessage<InvalidInput>(
                    StrEq("tangents need texture coordinates, but the mesh has none")));
    mesh.triangles[0].x = 99;
    EXPECT_THROW(framed(mesh, {}), InvalidInput);
    EXPECT_NO_THROW(framed(Mesh{}, with_tangents(NormalMode::keep)));
}

}  // namespace
}  // namespace relief
