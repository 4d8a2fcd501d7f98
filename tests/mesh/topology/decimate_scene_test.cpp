// SPDX-License-Identifier: Apache-2.0
// Decimation of several meshes together, and of parts that must keep their shape.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/topology.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/shapes.h"

namespace relief {
namespace {

struct SceneResult {
    std::vector<FramedMesh> meshes;
    std::vector<Report> reports;
    Report whole;

    [[nodiscard]] std::size_t triangles() const {
        std::size_t sum = 0;
        for (const FramedMesh& mesh : meshes)
            sum += mesh.mesh.triangles.size();
        return sum;
    }
};

SceneResult decimated_scene(const std::vector<Mesh>& meshes, const std::vector<double>& scales,
                            const DecimateOptions& options) {
    const Deformation none;
    std::vector<SceneMesh> scene;
    for (std::size_t i = 0; i < meshes.size(); ++i)
        scene.push_back({meshes[i], none, scales[i]});
    SceneResult result;
    result.reports.resize(meshes.size());
    result.meshes = decimated(scene, options, result.reports, result.whole);
    return result;
}

/// Returns a mesh with copies of another one, side by side.
Mesh copies(const Mesh& mesh, int count, float distance) {
    Mesh all;
    for (int i = 0; i < count; ++i) {
        const auto first = static_cast<std::uint32_t>(all.positions.size());
        for (const glm::vec3& p : mesh.positions)
            all.positions.push_back(p + glm::vec3(distance * static_cast<float>(i), 0.0F, 0.0F));
        for (const glm::uvec3& t : mesh.triangles)
            all.triangles.push_back(t + first);
    }
    return all;
}

Mesh bare(Mesh mesh) {
    mesh.normals.clear();
    mesh.texcoords.clear();
    mesh.tangents.clear();
    return mesh;
}

DecimateOptions to_triangles(std::size_t triangles) {
    DecimateOptions options;
    options.triangles = triangles;
    return options;
}

TEST(DecimateScene, OneMeshGivesTheResultOfTheOverloadForOne) {
    const Mesh torus = make_torus();
    DecimateOptions options = to_triangles(1500);
    options.fit_positions = true;
    const SceneResult scene = decimated_scene({torus}, {1.0}, options);
    const FramedMesh single = decimated(torus, options);
    EXPECT_EQ(scene.meshes[0].mesh.positions, single.mesh.positions);
    EXPECT_EQ(scene.meshes[0].mesh.triangles, single.mesh.triangles);
    EXPECT_EQ(scene.meshes[0].source_vertex, single.source_vertex);
}

TEST(DecimateScene, FlatMeshesAreReducedFirst) {
    // A flat grid needs two triangles. With equal ratios, the torus would keep half of its own.
    const Mesh grid = bare(test::grid(48));
    const Mesh torus = bare(make_torus());
    const std::size_t wanted = torus.triangles.size() / 4 * 3;
    const SceneResult scene = decimated_scene({grid, torus}, {1.0, 1.0}, to_triangles(wanted));
    EXPECT_EQ(scene.meshes[0].mesh.triangles.size(), 2U);
    EXPECT_LE(scene.triangles(), wanted);
    EXPECT_GE(scene.triangles() + 1, wanted);
    EXPECT_TRUE(scene.whole.empty());
}

TEST(DecimateScene, LargerInstancesKeepMoreTriangles) {
    const Mesh sphere = bare(make_sphere());
    const std::size_t wanted = sphere.triangles.size() / 2;
    for (const DecimateGoal goal :
         {DecimateGoal::picture, DecimateGoal::distance, DecimateGoal::largest_distance}) {
        DecimateOptions options = to_triangles(wanted);
        options.goal = goal;
        const SceneResult scene = decimated_scene({sphere, sphere}, {1.0, 8.0}, options);
        const std::size_t small = scene.meshes[0].mesh.triangles.size();
        const std::size_t large = scene.meshes[1].mesh.triangles.size();
        EXPECT_GT(large, 3 * small);
        EXPECT_GE(small, 12U);
        EXPECT_LE(small + large, wanted);
    }
}

TEST(DecimateScene, TheScaleOfTheWholeSceneChangesNoTriangle) {
    const Mesh sphere = bare(make_sphere());
    const Mesh torus = bare(make_torus());
    DecimateOptions options = to_triangles(2000);
    options.fit_positions = true;
    const SceneResult scene = decimated_scene({sphere, torus}, {1.0, 0.5}, options);
    const SceneResult larger = decimated_scene({sphere, torus}, {1024.0, 512.0}, options);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(scene.meshes[i].mesh.triangles, larger.meshes[i].mesh.triangles);
        EXPECT_EQ(scene.meshes[i].mesh.positions, larger.meshes[i].mesh.positions);
    }
}

TEST(DecimateScene, TexturesOfSomeMeshesStayThere) {
    const Mesh sphere = make_sphere();
    const Mesh torus = bare(make_torus());
    const SceneResult scene = decimated_scene({torus, sphere}, {1.0, 1.0}, to_triangles(1000));
    const FramedMesh& textured = scene.meshes[1];
    ASSERT_EQ(textured.mesh.texcoords.size(), textured.mesh.positions.size());
    for (std::size_t v = 0; v < textured.source_vertex.size(); ++v)
        EXPECT_EQ(textured.mesh.texcoords[v], sphere.texcoords[textured.source_vertex[v]]);
    EXPECT_TRUE(scene.meshes[0].mesh.texcoords.empty());
}

TEST_LABELS(not_sanitized);
TEST(DecimateScene, MaxErrorNeedsAtMostATenthMoreTrianglesThanTheBestNumber) {
    const Mesh mesh = bare(make_torus(0.4F, 32, 16));
    DecimateOptions options;
    options.goal = DecimateGoal::distance;
    options.fit_positions = true;
    constexpr double most = 0.06;
    const auto is_within = [&](std::size_t triangles) {
        options.triangles = triangles;
        const SurfaceDistance distance = surface_distance(mesh, decimated(mesh, options).mesh);
        return std::max(distance.from_a.max, distance.from_b.max) <= most;
    };
    std::size_t least = 4;
    std::size_t best = mesh.triangles.size();
    while (best - least > 1 + best / 50) {
        const std::size_t middle = (least + best) / 2;
        (is_within(middle) ? best : least) = middle;
    }
    options.triangles.reset();
    options.max_error = most;
    const std::size_t found = decimated(mesh, options).mesh.triangles.size();
    EXPECT_LE(static_cast<double>(found), 1.1 * static_cast<double>(best));
}

TEST_LABELS(not_sanitized);
TEST(DecimateScene, MaxErrorIsALengthOfTheScene) {
    const Mesh torus = bare(make_torus());
    DecimateOptions options;
    options.max_error = 0.01;
    const SceneResult scene = decimated_scene({torus, torus}, {1.0, 16.0}, options);
    EXPECT_LT(2 * scene.meshes[0].mesh.triangles.size(), scene.meshes[1].mesh.triangles.size());
    for (std::size_t i = 0; i < 2; ++i) {
        const SurfaceDistance distance = surface_distance(torus, scene.meshes[i].mesh);
        const double most = std::max(distance.from_a.max, distance.from_b.max);
        EXPECT_LE(most * (i == 0 ? 1.0 : 16.0), 0.01 * (1.0 + 1e-5));
    }
}

TEST(DecimateParts, QuadsKeepTheirTwoTriangles) {
    // With equal ratios, half of each quad would be missing.
    const Mesh quads = bare(copies(make_quad(), 29, 3.0F));
    const Mesh torus = bare(make_torus());
    const std::size_t all = quads.triangles.size() + torus.triangles.size();
    const SceneResult scene =
        decimated_scene({quads, torus}, {1.0, 1.0}, to_triangles(3 * all / 10));
    EXPECT_EQ(scene.meshes[0].mesh.triangles.size(), 58U);
    EXPECT_LE(scene.triangles(), 3 * all / 10);
}

TEST(DecimateParts, ReductionStopsBeforeAPartBreaks) {
    const Mesh quads = bare(copies(make_quad(), 29, 3.0F));
    Report report;
    const FramedMesh result = decimated(quads, to_triangles(20), report);
    EXPECT_EQ(result.mesh.triangles.size(), 58U);
    ASSERT_EQ(report.count("number of triangles out of reach"), 1U);
    EXPECT_EQ(report.findings()[0].outcome,
              "58 are left: 116 vertices whose part would lose its shape");
}

TEST(DecimateParts, ACubeKeepsItsCorners) {
    const Mesh cubes = bare(copies(make_cube(), 3, 5.0F));
    Report report;
    const FramedMesh result = decimated(cubes, to_triangles(10), report);
    EXPECT_EQ(result.mesh.triangles.size(), 36U);
}

TEST(DecimateParts, RoundPartsStayRound) {
    const Mesh sphere = bare(make_sphere());
    for (const DecimateGoal goal :
         {DecimateGoal::picture, DecimateGoal::distance, DecimateGoal::largest_distance}) {
        DecimateOptions options = to_triangles(4);
        options.goal = goal;
        options.fit_positions = true;
        Report report;
        const FramedMesh result = decimated(sphere, options, report);
        EXPECT_GE(result.mesh.triangles.size(), 12U);
        EXPECT_LT(result.mesh.triangles.size(), 64U);
        EXPECT_EQ(report.count("number of triangles out of reach"), 1U);
        EXPECT_LT(surface_distance(sphere, result.mesh).from_a.rms, 0.25);
    }
}

TEST(DecimateParts, SmallPartsGiveUpDetailBeforeTheNumberIsMissed) {
    // A sphere keeps about 30 triangles with an error of 3 % of its size.
    const Mesh spheres = bare(copies(make_sphere(), 3, 4.0F));
    Report report;
    const FramedMesh result = decimated(spheres, to_triangles(3 * 27), report);
    EXPECT_LE(result.mesh.triangles.size(), 81U);
    EXPECT_GE(result.mesh.triangles.size(), 79U);
    EXPECT_EQ(report.count("number of triangles out of reach"), 0U);
    ASSERT_EQ(report.count("small parts lose their shape"), 1U);
    EXPECT_EQ(report.findings()[0].outcome,
              "to reach the number of triangles, connected parts have errors of up to 6 % of their "
              "size");
    EXPECT_LT(surface_distance(spheres, result.mesh).from_a.rms, 0.2);
    Report of_many;
    decimated(spheres, to_triangles(3 * 60), of_many);
    EXPECT_EQ(of_many.count("small parts lose their shape"), 0U);
}

TEST(DecimateParts, SmallPartsVanishOnRequestOnly) {
    Mesh all = bare(copies(make_quad(), 5, 0.0F));
    // Quads of sides 2, 1, 1/2, 1/4 and 1/8.
    for (std::size_t v = 0; v < all.positions.size(); ++v)
        all.positions[v] = all.positions[v] / static_cast<float>(1U << (v / 4)) +
                           glm::vec3(4.0F * static_cast<float>(v / 4), 0.0F, 0.0F);
    DecimateOptions options = to_triangles(10);
    EXPECT_EQ(decimated(all, options).mesh.triangles.size(), 10U);
    options.drop_parts = 1.0;
    Report report;
    const FramedMesh result = decimated(all, options, report);
    EXPECT_EQ(result.mesh.triangles.size(), 4U);
    EXPECT_EQ(report.count("triangle of a small part"), 6U);
    options.drop_parts = 100.0;  // The largest part stays.
    EXPECT_EQ(decimated(all, options).mesh.triangles.size(), 2U);
}

TEST(DecimateScene, WrongArgumentsAreRefused) {
    const Mesh quad = make_quad();
    EXPECT_EQ(
        test::message_of<InvalidInput>([&] { decimated_scene({quad}, {0.0}, to_triangles(2)); }),
        "the scale of a mesh is 0, but must be finite and above 0");
    DecimateOptions options = to_triangles(2);
    options.drop_parts = -1.0;
    EXPECT_EQ(test::message_of<InvalidInput>([&] { decimated(quad, options); }),
              "the size of parts to drop is -1, but must be at least 0");
}

}  // namespace
}  // namespace relief
