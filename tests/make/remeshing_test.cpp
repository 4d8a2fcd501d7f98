// SPDX-License-Identifier: Apache-2.0
// The decision whether an asset is made from a closed surface around its source.
#include "relief/make/remeshing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "relief/make/asset.h"
#include "support/hard_meshes.h"
#include "support/manifold.h"
#include "support/shapes.h"
#include "tools/workplace.h"

namespace relief::make {
namespace {

using nlohmann::json;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

/// Adds a copy of a mesh at a place.
void add_part(Mesh& mesh, const Mesh& part, const glm::vec3& place) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::vec3& position : part.positions)
        mesh.positions.push_back(position + place);
    for (const glm::uvec3& triangle : part.triangles)
        mesh.triangles.push_back(triangle + first);
}

/// 100 spheres, most of whose area is inside of others.
Mesh overlapping_spheres() {
    Mesh mesh;
    const Mesh ball = test::sphere(12, 6);
    for (int i = 0; i < 100; ++i) {
        const auto x = static_cast<float>(i % 10);
        const auto y = static_cast<float>(i / 10 % 10);
        add_part(mesh, ball, 0.3F * glm::vec3(x, y, 0.2F * x));
    }
    return mesh;
}

/// The half of a closed surface at the top, without a part of the lower one.
Mesh bowl(int slices) {
    Mesh mesh = test::sphere(slices, slices / 2);
    std::erase_if(mesh.triangles, [&](const glm::uvec3& t) {
        return mesh.positions[t.x].y + mesh.positions[t.y].y + mesh.positions[t.z].y < -0.5F;
    });
    return test::mesh_from(mesh.positions, mesh.triangles);
}

AssetSource remesh_source(const Mesh& mesh) {
    AssetSource source;
    source.name = "asset";
    source.mesh = mesh;
    return source;
}

AssetOptions coarse_options(std::size_t triangles) {
    AssetOptions options;
    options.triangles = triangles;
    options.size = {64, 64};
    options.padding = 1;
    options.occlusion = false;
    options.resolution = 48;
    return options;
}

const Report& report_of_stage(const Asset& asset, const std::string& stage) {
    return std::ranges::find(asset.reports, stage, &StageReport::stage)->report;
}

const RemeshCriterion& criterion(const Asset& asset, const std::string& words) {
    return *std::ranges::find_if(asset.remesh->criteria, [&](const RemeshCriterion& one) {
        return one.name.find(words) != std::string::npos;
    });
}

constexpr const char* kept_finding = "triangles that exceed a limit for remeshing";

TEST(Remeshing, KeepsASoundMeshWithoutLookingInside) {
    const Asset asset = make_asset(remesh_source(test::sphere(32, 16)), coarse_options(200));
    ASSERT_TRUE(asset.remesh);
    EXPECT_FALSE(asset.remesh->is_remeshed);
    EXPECT_EQ(asset.remesh->reason, "no figure exceeds its limit");
    EXPECT_EQ(asset.remesh->criteria.size(), 4U);
    EXPECT_EQ(asset.remesh->triangles, 0U);
    EXPECT_FALSE(criterion(asset, "not seen").value);
    EXPECT_TRUE(report_of_stage(asset, "remesh").empty());
}

TEST(Remeshing, ReplacesShellsThatIntersect) {
    const Asset asset = make_asset(remesh_source(overlapping_spheres()), coarse_options(600));
    ASSERT_TRUE(asset.remesh->is_remeshed) << asset.remesh->reason;
    EXPECT_GT(*criterion(asset, "not seen").value, 0.5);
    EXPECT_THAT(asset.remesh->reason, HasSubstr("area that is not seen from outside"));
    EXPECT_LE(asset.mesh.triangles.size(), 600U);
    EXPECT_EQ(test::manifold_faults(asset.mesh).boundary_edges, 0U);
    // The parts alone cannot be reduced that far.
    AssetOptions never = coarse_options(600);
    never.remesh = Remeshing::never;
    const Asset parts = make_asset(remesh_source(overlapping_spheres()), never);
    EXPECT_FALSE(parts.remesh);
    EXPECT_GT(parts.mesh.triangles.size(), 600U);
    // The maps show the source, whose outermost surface is met almost everywhere.
    EXPECT_LT(asset.bake.texels_missed, asset.bake.texels_baked / 20);
}

TEST(Remeshing, DecidesTheSameForAnyOrderOfTrianglesAndThreads) {
    Mesh mesh = overlapping_spheres();
    AssetOptions options = coarse_options(600);
    options.execution.threads = 1;
    const Asset one = make_asset(remesh_source(mesh), options);
    std::ranges::reverse(mesh.triangles);
    options.execution.threads = 4;
    const Asset other = make_asset(remesh_source(mesh), options);
    EXPECT_EQ(*criterion(one, "not seen").value, *criterion(other, "not seen").value);
    EXPECT_EQ(one.remesh->distance->rms_of_source, other.remesh->distance->rms_of_source);
    EXPECT_EQ(one.mesh.positions, other.mesh.positions);
    EXPECT_EQ(one.mesh.triangles, other.mesh.triangles);
}

TEST(Remeshing, KeepsOpenWallsThatAClosedSurfaceWouldLose) {
    // Spheres that overlap exceed a limit, but the open bowl around them would vanish.
    Mesh mesh = overlapping_spheres();
    Mesh wall = bowl(48);
    for (glm::vec3& position : wall.positions)
        position *= 4.0F;
    add_part(mesh, wall, {1.3F, 1.3F, 0.3F});
    const Asset asset = make_asset(remesh_source(mesh), coarse_options(2000));
    ASSERT_TRUE(asset.remesh);
    EXPECT_FALSE(asset.remesh->is_remeshed);
    ASSERT_TRUE(asset.remesh->distance) << asset.remesh->reason;
    EXPECT_GT(asset.remesh->distance->max_of_source, max_remesh_distance * asset.remesh->cell);
    EXPECT_LT(asset.remesh->distance->max_of_surface, max_remesh_distance * asset.remesh->cell);
    EXPECT_THAT(asset.remesh->reason, HasSubstr("cells away"));
    EXPECT_EQ(report_of_stage(asset, "remesh").count(kept_finding), 1U);
    // The bowl has about twenty triangles. The spheres end at 3.7.
    EXPECT_GT(bounds_of(asset.mesh).max.x, 4.5F) << "the bowl is in the asset";
    AssetOptions shell = coarse_options(2000);
    shell.shell = true;
    const Asset shells = make_asset(remesh_source(mesh), shell);
    EXPECT_TRUE(shells.remesh->is_remeshed) << shells.remesh->reason;
    EXPECT_GT(bounds_of(shells.mesh).max.x, 5.0F);
}

TEST(Remeshing, KeepsAMeshThatEnclosesNothing) {
    // Twelve sheets around one line.
    Mesh mesh;
    for (int i = 0; i < 12; ++i) {
        Mesh sheet;
        sheet.positions = {{0, 0, 0},
                           {0, 0, 1},
                           {1, 0.1F * static_cast<float>(i), 0},
                           {1, 0.1F * static_cast<float>(i), 1}};
        sheet.triangles = {{0, 1, 2}, {2, 1, 3}};
        add_part(mesh, sheet, glm::vec3(0.0F));
    }
    const Asset asset = make_asset(remesh_source(mesh), coarse_options(24));
    EXPECT_FALSE(asset.remesh->is_remeshed);
    EXPECT_TRUE(criterion(asset, "three or more").is_exceeded());
    EXPECT_THAT(asset.remesh->reason, HasSubstr("enclose nothing"));
    EXPECT_EQ(report_of_stage(asset, "remesh").count(kept_finding), 1U);
    AssetOptions always = coarse_options(24);
    always.remesh = Remeshing::always;
    EXPECT_THROW(make_asset(remesh_source(mesh), always), InvalidInput);
}

TEST(Remeshing, ReplacesTrianglesOnRequest) {
    AssetOptions options = coarse_options(100);
    options.remesh = Remeshing::always;
    const Asset asset = make_asset(remesh_source(test::cube()), options);
    EXPECT_TRUE(asset.remesh->is_remeshed);
    EXPECT_TRUE(asset.remesh->criteria.empty());
    EXPECT_GT(asset.remesh->triangles, 1000U);
    EXPECT_LE(asset.mesh.triangles.size(), 100U);
    EXPECT_LT(asset.remesh->distance->max_of_source, asset.remesh->cell);
    std::vector<std::string> stages;
    for (const StageReport& stage : asset.reports)
        stages.push_back(stage.stage);
    EXPECT_EQ(stages, stages_of(options));
    options.keep_texcoords = true;
    EXPECT_THROW(make_asset(remesh_source(test::grid(4)), options), InvalidInput);
}

TEST(Remeshing, DecimatesBothSidesOfDoubledWallsAsOne) {
    const Mesh single = test::wavy_grid(24);
    Mesh both = test::mesh_from(single.positions, single.triangles);
    for (const glm::uvec3& t : single.triangles)
        both.triangles.emplace_back(t.x, t.z, t.y);
    const Asset expected = make_asset(
        remesh_source(test::mesh_from(single.positions, single.triangles)), coarse_options(200));
    const Asset asset = make_asset(remesh_source(both), coarse_options(400));
    EXPECT_FALSE(asset.remesh->is_remeshed);
    EXPECT_GE(report_of_stage(asset, "decimate").count("double-sided triangle"),
              single.triangles.size());
    EXPECT_NEAR(static_cast<double>(asset.mesh.triangles.size()),
                static_cast<double>(2 * expected.mesh.triangles.size()), 4.0);
    // Two sides, and at most twice the charts on each.
    EXPECT_LE(asset.atlas->charts, 4 * expected.atlas->charts);
    // Rays meet the side in front, except at the border, where both sides are at one place.
    EXPECT_LT(report_of_stage(asset, "bake").count("normal behind the surface"),
              asset.bake.texels_baked / 10);
    EXPECT_TRUE(test::manifold_faults(asset.mesh).is_manifold());
}

TEST(RemeshCommand, StatesItsFiguresAndRefusesUselessOptions) {
    const Workplace workplace;
    const std::string line =
        "relief make data/vase.obj out/a.glb --triangles 200 --size 32 --padding 1 "
        "--occlusion-rays 0 ";
    const ProgramResult made = workplace.run(line + "--report out/a.json");
    ASSERT_EQ(made.exit_code, 0) << made.error;
    EXPECT_THAT(made.out, HasSubstr("remesh    the mesh is kept: "));
    EXPECT_THAT(made.out, HasSubstr("edges of three or more triangles: 0 % (limit 2 %)"));
    json report = json::parse(workplace.read("out/a.json"))["remesh"];
    EXPECT_EQ(report["remeshed"], false);
    EXPECT_EQ(report["criteria"].size(), 4U);
    const ProgramResult always =
        workplace.run(line + "--remesh always --resolution 24 --shell --report out/a.json");
    ASSERT_EQ(always.exit_code, 0) << always.error;
    EXPECT_THAT(always.out, HasSubstr("replaces the mesh: it was requested"));
    report = json::parse(workplace.read("out/a.json"));
    EXPECT_EQ(report["remesh"]["remeshed"], true);
    EXPECT_GT(report["remesh"]["distance"]["max_of_source"].get<double>(), 0.0);
    EXPECT_THAT(report["command"].get<std::string>(),
                HasSubstr(" --remesh always --resolution 24 --shell"));
    EXPECT_THAT(workplace.run(line + "--explain").out,
                HasSubstr("measure whether the mesh needs a closed surface of 256 cells"));
    EXPECT_THAT(workplace.run(line + "--explain --remesh always").out,
                HasSubstr("replace the triangles by a closed surface of 256 cells"));
    test::expect_refusals(
        workplace, "relief", "a.glb a.json",
        {{line + "--remesh never --resolution 64", 2, "--resolution: has no effect"},
         {line + "--keep-uvs --shell", 2, "--shell: has no effect"},
         {line + "--keep-uvs --remesh always", 2,
          "--remesh always and --keep-uvs contradict each other"},
         {line + "--remesh sometimes", 2, "--remesh sometimes"},
         {line + "--resolution 4", 2, "--resolution 4"}});
}

TEST(RemeshCommand, PrintedCommandRepeatsAJobThatKeepsTextureCoordinates) {
    const Workplace workplace;
    ASSERT_EQ(workplace
                  .run("relief make data/vase.obj out/a.glb --triangles 200 --size 32 --padding 1 "
                       "--occlusion-rays 0 --keep-uvs --report out/a.json")
                  .exit_code,
              0);
    const std::string asset = workplace.read("out/a.glb");
    const json report = json::parse(workplace.read("out/a.json"));
    const ProgramResult again = workplace.run(report["command"].get<std::string>());
    EXPECT_EQ(again.exit_code, 0) << again.error;
    EXPECT_TRUE(workplace.read("out/a.glb") == asset);
}

}  // namespace
}  // namespace relief::make
