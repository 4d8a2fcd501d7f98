// SPDX-License-Identifier: Apache-2.0
// The stages from a dense mesh to an asset, on small meshes in memory.
#include "relief/make/asset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/model.h"
#include "relief/mesh/topology.h"
#include "support/hard_meshes.h"
#include "support/labels.h"
#include "support/shapes.h"
#include "tools/workplace.h"

namespace relief::make {
namespace {

using testing::HasSubstr;

/// A sphere with ripples, without attributes but positions.
Mesh rippled_sphere(int slices) {
    Mesh mesh = test::sphere(slices, slices / 2);
    for (glm::vec3& position : mesh.positions) {
        const float ripple = std::sin(12.0F * position.x) * std::sin(12.0F * position.y);
        position *= 1.0F + 0.03F * ripple;
    }
    return test::mesh_from(mesh.positions, mesh.triangles);
}

AssetSource source_of(const Mesh& mesh) {
    AssetSource source;
    source.name = "asset";
    source.mesh = mesh;
    return source;
}

/// Small maps and few rays.
AssetOptions quick_options(std::size_t triangles) {
    AssetOptions options;
    options.triangles = triangles;
    options.size = {64, 64};
    options.padding = 2;
    options.occlusion_rays = 4;
    return options;
}

/// Expects what every asset has.
void expect_sound(const Asset& asset) {
    const Mesh& mesh = asset.mesh;
    ASSERT_FALSE(mesh.triangles.empty());
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    ASSERT_EQ(mesh.texcoords.size(), mesh.positions.size());
    ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        EXPECT_TRUE(std::isfinite(glm::dot(mesh.positions[i], glm::vec3(1.0F)))) << i;
        EXPECT_NEAR(glm::length(mesh.normals[i]), 1.0F, 1e-5F) << i;
        EXPECT_NEAR(std::abs(mesh.tangents[i].w), 1.0F, 0.0F) << i;
        EXPECT_GE(mesh.texcoords[i].x, 0.0F);
        EXPECT_LE(mesh.texcoords[i].x, 1.0F);
    }
    EXPECT_GT(asset.bake.texels_baked, 0U);
    EXPECT_EQ(asset.normal_map.sample_count(), asset.normal_map.as<std::uint8_t>().size());
}

const Report& report_of(const Asset& asset, const std::string& stage) {
    return std::ranges::find(asset.reports, stage, &StageReport::stage)->report;
}

TEST(MakeAsset, KeepsTheShapeOfManySmallParts) {
    const Mesh part = test::sphere(16, 8);
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    for (int i = 0; i < 64; ++i) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        for (const glm::vec3& position : part.positions)
            positions.push_back(position + glm::vec3(3 * (i % 8), 3 * (i / 8), 0));
        for (const glm::uvec3& triangle : part.triangles)
            triangles.push_back(triangle + first);
    }
    AssetOptions options = quick_options(600);
    options.occlusion = false;
    options.remesh = Remeshing::never;
    Mesh before;
    options.take_mesh = [&](std::string_view stage, const StageMesh& after) {
        const Mesh& mesh = after.mesh;
        if (stage == "repair") before = test::mesh_from(mesh.positions, mesh.triangles);
    };
    const Asset asset = make_asset(source_of(test::mesh_from(positions, triangles)), options);
    DecimateOptions limits;
    limits.triangles = 600;
    limits.goal = DecimateGoal::distance;
    limits.fit_positions = true;
    EXPECT_EQ(asset.mesh.triangles.size(),
              decimated(before, limits, IgnoredReport()).mesh.triangles.size());
    EXPECT_GT(asset.mesh.triangles.size(), 600U);
}

TEST(MakeAsset, HasTheRequestedTrianglesAndMaps) {
    const Asset asset = make_asset(source_of(rippled_sphere(64)), quick_options(300));
    expect_sound(asset);
    EXPECT_NEAR(static_cast<double>(asset.mesh.triangles.size()), 300.0, 2.0);
    EXPECT_EQ(asset.normal_map.width, 64);
    ASSERT_TRUE(asset.occlusion_map);
    EXPECT_EQ(asset.occlusion_map->width, 16);
    EXPECT_FALSE(asset.color_map) << "the source has one color";
    EXPECT_EQ(asset.bake.texels_missed, 0U);
    std::vector<std::string> stages;
    for (const StageReport& stage : asset.reports)
        stages.push_back(stage.stage);
    EXPECT_EQ(stages, stages_of(quick_options(300)));
}

TEST(MakeAsset, IsTheSameForAnyNumberOfThreads) {
    AssetSource source = source_of(rippled_sphere(48));
    for (const glm::vec3& position : source.mesh.positions)
        source.mesh.colors.emplace_back(glm::abs(position), 1.0F);
    AssetOptions options = quick_options(200);
    options.execution.threads = 1;
    const Asset one = make_asset(source, options);
    options.execution.threads = 5;
    const Asset five = make_asset(source, options);
    EXPECT_EQ(one.mesh.positions, five.mesh.positions);
    EXPECT_EQ(one.mesh.texcoords, five.mesh.texcoords);
    EXPECT_EQ(one.mesh.tangents, five.mesh.tangents);
    EXPECT_EQ(one.mesh.triangles, five.mesh.triangles);
    EXPECT_EQ(one.normal_map.samples, five.normal_map.samples);
    EXPECT_EQ(one.occlusion_map->samples, five.occlusion_map->samples);
    ASSERT_TRUE(one.color_map && five.color_map);
    EXPECT_EQ(one.color_map->samples, five.color_map->samples);
}

TEST(MakeAsset, RunsEachStageThroughTheCallback) {
    std::vector<std::string> stages;
    AssetOptions options = quick_options(100);
    options.run_stage = [&](std::string_view stage, const std::function<void()>& work) {
        work();
        stages.emplace_back(stage);
    };
    make_asset(source_of(rippled_sphere(24)), options);
    EXPECT_EQ(stages, stages_of(options));
}

TEST(MakeAsset, CodesNormalsWithTheRequestedBits) {
    const AssetSource source = source_of(rippled_sphere(32));
    AssetOptions options = quick_options(100);
    options.keep_baked_normals = true;
    const Asset coarse = make_asset(source, options);
    EXPECT_EQ(coarse.normal_map.bits(), 8);
    ASSERT_TRUE(coarse.baked_normals);
    EXPECT_EQ(coarse.baked_normals->bits(), 16);
    options.keep_baked_normals = false;
    options.normal_bits = 16;
    const Asset fine = make_asset(source, options);
    EXPECT_FALSE(fine.baked_normals);
    EXPECT_EQ(fine.normal_map.samples, coarse.baked_normals->samples);
    const auto rough = coarse.normal_map.as<std::uint8_t>();
    const auto exact = fine.normal_map.as<std::uint16_t>();
    ASSERT_EQ(rough.size(), exact.size());
    for (std::size_t i = 0; i < rough.size(); ++i)
        ASSERT_NEAR(rough[i] / 255.0, exact[i] / 65535.0, 0.5 / 255.0 + 1.0 / 65535.0) << i;
    options.normal_bits = 12;
    EXPECT_THROW(make_asset(source, options), InvalidInput);
}

TEST(MakeAsset, KeepsTextureCoordinates) {
    AssetOptions options = quick_options(60);
    options.keep_texcoords = true;
    EXPECT_THROW(make_asset(source_of(rippled_sphere(24)), options), InvalidInput);
    Mesh grid = test::grid(16);
    grid.normals.clear();
    const Asset asset = make_asset(source_of(grid), options);
    expect_sound(asset);
    EXPECT_FALSE(asset.atlas);
    for (std::size_t i = 0; i < asset.mesh.positions.size(); ++i)
        EXPECT_NEAR(asset.mesh.texcoords[i].x, asset.mesh.positions[i].x, 1e-4F);
}

TEST(MakeAsset, KeepsASourceWithFewerTrianglesAndReportsIt) {
    const Asset asset = make_asset(source_of(test::cube()), quick_options(5000));
    expect_sound(asset);
    EXPECT_EQ(asset.mesh.triangles.size(), 12U);
    EXPECT_EQ(report_of(asset, "decimate").count("source with fewer triangles than requested"), 1U);
    // The edges of a cube are hard at 60 degrees.
    EXPECT_EQ(asset.mesh.positions.size(), 24U);
}

TEST(MakeAsset, HasTheOnlyColorOfTheSource) {
    AssetSource source = source_of(rippled_sphere(24));
    source.otherwise.emplace().color = {0.2F, 0.4F, 0.6F};
    const Asset asset = make_asset(source, quick_options(100));
    EXPECT_FALSE(asset.color_map);
    EXPECT_EQ(asset.material.metallic_roughness->base_color, glm::vec3(0.2F, 0.4F, 0.6F));
}

// Inputs that must end well. Each has a stated outcome.

TEST(MakeAssetInputs, RemovesTrianglesWithoutFinitePositions) {
    Mesh mesh = rippled_sphere(24);
    mesh.positions[100].x = test::not_a_number;
    mesh.positions[200].y = test::infinite;
    const Asset asset = make_asset(source_of(mesh), quick_options(200));
    expect_sound(asset);
    const std::size_t removed = mesh.triangles.size() - asset.source_triangles;
    const Report& repair = report_of(asset, "repair");
    const std::size_t not_finite = repair.count("triangle with a non-finite corner");
    EXPECT_GT(not_finite, 0U);
    EXPECT_EQ(not_finite + repair.count("collapsed triangle"), removed) << "some are at the poles";
    AssetOptions as_it_is = quick_options(200);
    as_it_is.repair.reset();
    EXPECT_EQ(report_of(make_asset(source_of(mesh), as_it_is), "repair")
                  .count("triangle without area or with a position that is not finite"),
              removed);
    for (glm::vec3& position : mesh.positions)
        position.x = test::not_a_number;
    try {
        make_asset(source_of(mesh), quick_options(200));
        FAIL();
    } catch (const InvalidInput& error) {
        EXPECT_THAT(error.what(), HasSubstr("no triangle with an area and finite positions"));
    }
}

TEST(MakeAssetInputs, AcceptsSoups) {
    const Mesh sphere = rippled_sphere(32);
    Mesh soup;
    for (const glm::uvec3& triangle : sphere.triangles) {
        const auto first = static_cast<std::uint32_t>(soup.positions.size());
        for (int i = 0; i < 3; ++i)
            soup.positions.push_back(sphere.positions[triangle[i]]);
        soup.triangles.emplace_back(first, first + 1, first + 2);
    }
    const Asset asset = make_asset(source_of(soup), quick_options(300));
    expect_sound(asset);
    EXPECT_NEAR(static_cast<double>(asset.mesh.triangles.size()), 300.0, 2.0);
}

TEST(MakeAssetInputs, AcceptsOpenSurfaces) {
    Mesh open = rippled_sphere(32);
    open.triangles.resize(open.triangles.size() / 2);
    expect_sound(make_asset(source_of(open), quick_options(200)));
}

TEST(MakeAssetInputs, AcceptsDoubledWalls) {
    // The same surface twice, facing both ways, with a small gap.
    Mesh mesh = test::wavy_grid(12);
    const auto count = static_cast<std::uint32_t>(mesh.positions.size());
    const std::size_t triangles = mesh.triangles.size();
    for (std::uint32_t i = 0; i < count; ++i)
        mesh.positions.push_back(mesh.positions[i] - glm::vec3(0.0F, 0.0F, 0.05F));
    for (std::size_t i = 0; i < triangles; ++i) {
        const glm::uvec3 triangle = mesh.triangles[i];
        mesh.triangles.push_back(glm::uvec3(triangle.x, triangle.z, triangle.y) + count);
    }
    const Asset asset =
        make_asset(source_of(test::mesh_from(mesh.positions, mesh.triangles)), quick_options(150));
    expect_sound(asset);
}

TEST(MakeAssetInputs, AcceptsPartsThatFaceInwards) {
    Mesh mesh = rippled_sphere(24);
    for (std::size_t i = 0; i < mesh.triangles.size() / 3; ++i)
        std::swap(mesh.triangles[i].y, mesh.triangles[i].z);
    const Asset asset = make_asset(source_of(mesh), quick_options(300));
    expect_sound(asset);
    // The 24 triangles with an edge at the pole have no area.
    EXPECT_EQ(report_of(asset, "repair").count("triangle with the wrong winding"),
              mesh.triangles.size() / 3 - 24);
    for (const glm::uvec3& triangle : asset.mesh.triangles) {
        const glm::vec3& a = asset.mesh.positions[triangle.x];
        const glm::vec3 normal =
            glm::cross(asset.mesh.positions[triangle.y] - a, asset.mesh.positions[triangle.z] - a);
        EXPECT_GT(glm::dot(normal, a), 0.0F) << "the sphere is around the origin";
    }
}

TEST(MakeAssetInputs, KeepsAllOfAHundredParts) {
    Mesh mesh;
    const Mesh ball = test::sphere(12, 6);
    for (int part = 0; part < 100; ++part) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        const glm::vec3 center(3.0F * static_cast<float>(part % 10),
                               3.0F * static_cast<float>(part / 10), 0.0F);
        for (const glm::vec3& position : ball.positions)
            mesh.positions.push_back(position + center);
        for (const glm::uvec3& triangle : ball.triangles)
            mesh.triangles.push_back(triangle + first);
    }
    const Asset asset = make_asset(source_of(mesh), quick_options(3000));
    expect_sound(asset);
    const Bounds before = bounds_of(mesh);
    const Bounds after = bounds_of(asset.mesh);
    EXPECT_LT(glm::length(before.max - after.max), 0.5F);
}

TEST(MakeAssetInputs, AcceptsAnyUnitOfLength) {
    const Asset one = make_asset(source_of(rippled_sphere(24)), quick_options(200));
    for (const float scale : {1e-6F, 1e6F}) {
        Mesh mesh = rippled_sphere(24);
        for (glm::vec3& position : mesh.positions)
            position *= scale;
        const Asset asset = make_asset(source_of(mesh), quick_options(200));
        expect_sound(asset);
        EXPECT_NEAR(static_cast<double>(asset.mesh.triangles.size()),
                    static_cast<double>(one.mesh.triangles.size()), 2.0);
        EXPECT_EQ(asset.bake.texels_missed, 0U) << scale;
    }
}

// The catalog of hard cases: non-manifold, folded, needle-thin, huge, far away, ...
TEST_LABELS(slow);
TEST(MakeAssetInputs, EndsWellOnEveryHardMesh) {
    for (const test::NamedMesh& hard : test::hard_meshes()) {
        SCOPED_TRACE(hard.name);
        AssetOptions options = quick_options(20);
        options.size = {32, 32};
        options.occlusion_rays = 1;
        try {
            const Asset asset = make_asset(
                source_of(test::mesh_from(hard.mesh.positions, hard.mesh.triangles)), options);
            ASSERT_FALSE(asset.mesh.triangles.empty());
            EXPECT_EQ(asset.mesh.tangents.size(), asset.mesh.positions.size());
        } catch (const InvalidInput& error) {
            EXPECT_STRNE(error.what(), "");
        }
    }
}

// Files.

class WrittenAsset : public testing::Test {
  protected:
    void SetUp() override {
        AssetSource source = source_of(rippled_sphere(48));
        for (const glm::vec3& position : source.mesh.positions)
            source.mesh.colors.emplace_back(glm::abs(position), 1.0F);
        asset = make_asset(source, quick_options(400));
    }

    test::TemporaryDirectory folder;
    Asset asset;
};

TEST_F(WrittenAsset, IsReadBackAsItWasMade) {
    for (const char* name : {"a.glb", "a.gltf"}) {
        Report report;
        const std::vector<AssetLevel> levels = write_asset(folder / name, asset, 2, report);
        EXPECT_TRUE(report.empty()) << to_string(report.findings().front());
        ASSERT_EQ(levels.size(), 2U);
        EXPECT_NEAR(static_cast<double>(levels[0].triangles), 200.0, 3.0);
        EXPECT_GT(levels[0].pixels, levels[1].pixels);
        const Report problems = verify_asset(folder / name, asset);
        EXPECT_TRUE(problems.empty()) << to_string(problems.findings().front());
        const GltfView view = test::read_document(folder / name).view();
        EXPECT_EQ(view.images.size(), 3U);
        EXPECT_EQ(view.images.front().name, "a_normal");
    }
}

TEST_F(WrittenAsset, KeepsSixteenBits) {
    AssetOptions options = quick_options(100);
    options.normal_bits = 16;
    const Asset fine = make_asset(source_of(rippled_sphere(24)), options);
    write_asset(folder / "fine.glb", fine, 0);
    EXPECT_TRUE(verify_asset(folder / "fine.glb", fine).empty());
}

TEST_F(WrittenAsset, HasTheRoughnessOfTheSource) {
    for (const float roughness : {1.0F, 0.5F, 0.0F}) {
        AssetSource source = source_of(test::cube());
        source.otherwise.emplace().roughness = roughness;
        write_asset(folder / "a.glb", make_asset(source, quick_options(12)), 0);
        const GltfView view = test::read_document(folder / "a.glb").view();
        const MetallicRoughness& surface = *view.materials.front().metallic_roughness;
        EXPECT_EQ(surface.roughness, roughness);
        EXPECT_EQ(surface.metallic, 0.0F);
    }
}

TEST_F(WrittenAsset, DiffersFromAnotherOne) {
    write_asset(folder / "a.glb", asset, 0);
    Asset other = asset;
    other.normal_map.as<std::uint8_t>()[30] ^= 1U;
    EXPECT_EQ(verify_asset(folder / "a.glb", other).count("map with other texels"), 1U);
    other = asset;
    other.mesh.triangles.pop_back();
    EXPECT_EQ(verify_asset(folder / "a.glb", other).count("another number of triangles"), 1U);
}

// Levels have the texture of the whole mesh: where a chart loses a part of its outline, triangles
// can share texels. The mesh that was baked never does.
TEST_F(WrittenAsset, NamesLevelsWhoseTrianglesShareTexels) {
    for (const std::size_t mesh : {0, 1}) {
        write_asset(folder / "a.glb", asset, 1);
        GltfDocument document = test::read_document(folder / "a.glb");
        // Each vertex gets the texture coordinates of another one.
        change_triangles(
            document, std::array{mesh}, NormalMode::keep, [](const TriangleInput& before, Report&) {
                FramedMesh after = with_frames(before.mesh, {.normals = NormalMode::keep});
                std::ranges::reverse(after.source_vertex);
                return after;
            });
        document.write(folder / "a.glb");
        const Report problems = verify_asset(folder / "a.glb", asset);
        EXPECT_EQ(problems.count("overlapping texture") > 0, mesh == 0);
        EXPECT_EQ(problems.count("overlapping texture in a level of detail") > 0, mesh == 1);
    }
}

TEST_F(WrittenAsset, StopsAtTheSmallestLevel) {
    Report report;
    const std::vector<AssetLevel> levels = write_asset(folder / "a.glb", asset, 16, report);
    EXPECT_LT(levels.size(), 16U);
    EXPECT_EQ(report.count("level of detail that cannot get smaller"), 1U);
}

}  // namespace
}  // namespace relief::make
