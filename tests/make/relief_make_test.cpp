// SPDX-License-Identifier: Apache-2.0
// The tool relief: `relief make`, and the other tools as its commands.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "relief/mesh/image_file.h"
#include "relief/mesh/mesh_file.h"
#include "support/labels.h"
#include "tools/linked_tools.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

constexpr const char* quick = " --triangles 400 --size 64 --padding 2 --occlusion-rays 2";

TEST(MakeCommand, MakesAnAssetThatPassesTheChecks) {
    const Workplace workplace;
    const ProgramResult result =
        workplace.run(std::string("relief make data/urn-high.ply out/urn.glb --lods 1 "
                                  "--report out/urn.json") +
                      quick);
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("asset     400 triangles, "));
    EXPECT_THAT(result.out, HasSubstr("LOD1: 200 triangles"));
    EXPECT_EQ(workplace.outputs(), "urn.glb urn.json");
    const ProgramResult check = workplace.run("relief-mesh check out/urn.glb --for-baking");
    EXPECT_EQ(check.exit_code, 0) << check.out << check.error;
    const json report = json::parse(workplace.read("out/urn.json"));
    EXPECT_EQ(report["tool"], "relief make");
    EXPECT_EQ(report["triangles"], 400);
    EXPECT_EQ(report["source"]["triangles"], 26800);
    EXPECT_EQ(report["maps"][0]["width"], 64);
    EXPECT_EQ(report["maps"][1]["content"], "occlusion");
    std::vector<std::string> stages;
    for (const json& stage : report["stages"]) {
        stages.push_back(stage["stage"]);
        EXPECT_GT(stage["peak_bytes"].get<double>(), 1e6);
        EXPECT_GE(stage["processor_milliseconds"].get<double>(), 0.0);
    }
    EXPECT_EQ(stages, (std::vector<std::string>{"read", "repair", "decimate", "unwrap", "remesh",
                                                "frames", "bake", "write", "verify"}));
}

// The shells end in steps, beside which a vertex of the first level became a spike of 0.056, and
// then of all levels. Its triangles also covered texels of others.
TEST(MakeCommand, MakesLevelsWithoutSpikes) {
    const Workplace workplace;
    const ProgramResult result = workplace.run(
        "relief make data/fossil.ply out/a.glb --triangles 3000 --size 256 --lods 3 "
        "--occlusion-rays 2 --report out/a.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, Not(HasSubstr("overlapping texture")));
    const json report = json::parse(workplace.read("out/a.json"));
    const json& levels = report["levels"];
    ASSERT_EQ(levels.size(), 3U);
    EXPECT_LT(levels[0]["distance"].get<double>(), 0.02);
    EXPECT_LT(levels[2]["distance"].get<double>(), 0.04);
    EXPECT_GT(levels[0]["pixels"].get<double>(), 2.0 * levels[2]["pixels"].get<double>());
}

TEST(MakeCommand, ReducesForSmallDistancesBecauseMapsHaveTheNormals) {
    const Workplace workplace;
    const ProgramResult result = workplace.run(
        "relief make data/urn-high.ply out/urn.glb --triangles 1000 --size 64 --padding 2 "
        "--occlusion-rays 0 --keep-stages out/stages");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    for (const char* goal : {"distance", "picture"}) {
        ASSERT_EQ(workplace
                      .run(fmt::format("relief-mesh decimate data/urn-high.ply out/{0}.ply "
                                       "--triangles 1000 --for {0}",
                                       goal))
                      .exit_code,
                  0);
    }
    ASSERT_EQ(
        workplace.run("relief-mesh process out/stages/03-decimate.glb out/asset.ply").exit_code, 0);
    const auto places = [&](const char* file) {
        std::set<std::array<float, 3>> all;
        for (const glm::vec3& p : read_mesh(workplace / file).mesh.positions)
            all.insert({p.x, p.y, p.z});
        return all;
    };
    EXPECT_EQ(places("out/asset.ply"), places("out/distance.ply"));
    EXPECT_NE(places("out/asset.ply"), places("out/picture.ply"));
}

TEST(MakeCommand, WritesTheSameBytesForAnyNumberOfThreads) {
    const Workplace workplace;
    const std::string line = std::string("relief make data/urn-high.ply") + quick + " --lods 1";
    ASSERT_EQ(workplace.run(line + " -o out/a.glb --threads 1").exit_code, 0);
    std::filesystem::rename(workplace / "out/a.glb", workplace / "out/b.glb");
    ASSERT_EQ(workplace.run(line + " -o out/a.glb --threads 3").exit_code, 0);
    EXPECT_EQ(workplace.read("out/a.glb"), workplace.read("out/b.glb"));
}

TEST(MakeCommand, ReadsEveryFormat) {
    const Workplace workplace;
    workplace.write_square("out/square.obj");
    for (const char* format : {"ply", "glb", "gltf"}) {
        SCOPED_TRACE(format);
        const std::string input = std::string("out/a.") + format;
        ASSERT_EQ(workplace.run("relief-mesh process out/square.obj " + input).exit_code, 0);
        const ProgramResult result =
            workplace.run("relief make " + input + " -o out/assets/" + quick);
        EXPECT_EQ(result.exit_code, 0) << result.error;
    }
    workplace.write("out/a.stl",
                    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 "
                    "1 0\nendloop\nendfacet\nendsolid a\n");
    const ProgramResult result =
        workplace.run(std::string("relief make out/a.stl out/stl.glb") + quick);
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("source with fewer triangles than requested"));
}

TEST(MakeCommand, TurnsTheUpAxisOfStlFilesToThatOfGltf) {
    const Workplace workplace;
    // A pyramid with its tip at z = 2.
    const std::string points[5] = {"0 0 0", "1 0 0", "1 1 0", "0 1 0", "0 0 2"};
    constexpr int triangles[6][3] = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4},
                                     {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    std::string stl = "solid a\n";
    std::string off = "OFF\n5 6 0\n";
    for (const std::string& point : points)
        off += point + "\n";
    for (const auto& [a, b, c] : triangles) {
        stl += "facet normal 0 0 0\nouter loop\nvertex " + points[a] + "\nvertex " + points[b] +
               "\nvertex " + points[c] + "\nendloop\nendfacet\n";
        off += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
    }
    workplace.write("out/a.stl", stl + "endsolid a\n");
    workplace.write("out/a.off", off);
    const auto bounds_with = [&](const std::string& arguments, const char* line) {
        const ProgramResult result =
            workplace.run("relief make " + arguments + " -o out/a.glb" + quick);
        EXPECT_EQ(result.exit_code, 0) << result.error;
        EXPECT_THAT(result.out, HasSubstr(line));
        const GltfDocument document = test::read_document(workplace / "out/a.glb");
        return bounds_of(document.mesh(document.triangle_primitives().front()));
    };
    const Bounds turned =
        bounds_with("out/a.stl --loss --report out/a.json", ", z up (y in the asset)");
    EXPECT_EQ(turned.min, glm::vec3(0.0F, 0.0F, -1.0F));
    EXPECT_EQ(turned.max, glm::vec3(1.0F, 2.0F, 0.0F));
    // The source of the loss is rotated alike.
    const json loss = json::parse(workplace.read("out/a.json"))["loss"];
    EXPECT_EQ(loss["figures"][0]["name"], "FLIP, studio");
    EXPECT_LT(loss["figures"][0]["mean"].get<double>(), 0.05);
    EXPECT_LT(loss["stages"].back()["distance_from_source"]["max"].get<double>(), 1e-6);
    EXPECT_EQ(bounds_with("out/a.stl --up y", "STL, 6 triangles").max, glm::vec3(1.0F, 1.0F, 2.0F));
    EXPECT_EQ(bounds_with("out/a.off --up z", "z up").max, turned.max);
    EXPECT_EQ(bounds_with("out/a.off", "OFF").max, glm::vec3(1.0F, 1.0F, 2.0F));
}

TEST(MakeCommand, WritesMapsForEngines) {
    const Workplace workplace;
    const ProgramResult result = workplace.run(
        std::string("relief make data/urn-high.ply out/urn.glb --for unreal") + quick);
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(workplace.outputs(), "urn.glb urn_N.png urn_ORM.png");
    const ImageInfo info = read_image_info(workplace / "out/urn_N.png");
    EXPECT_EQ(info.metadata.at("relief:green"), "down");
    EXPECT_EQ(info.width, 64);
    EXPECT_EQ(read_image_info(workplace / "out/urn_ORM.png").width, 16);
}

TEST(MakeCommand, MakesManyAssetsAlthoughOneFails) {
    const Workplace workplace;
    workplace.write("out/empty.ply", "");
    workplace.write_square("out/square.obj");
    const ProgramResult result = workplace.run(
        std::string("relief make out/empty.ply out/square.obj data/vase.obj -o out/assets/") +
        quick);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, HasSubstr("empty.ply: "));
    EXPECT_TRUE(std::filesystem::exists(workplace / "out/assets/square.glb"));
    EXPECT_TRUE(std::filesystem::exists(workplace / "out/assets/vase.glb"));
}

TEST(MakeCommand, LeavesOutMissingTextures) {
    const Workplace workplace;
    workplace.write_square("out/square.obj");
    const std::string text = workplace.read("out/square.obj");
    workplace.write("out/square.obj", "mtllib square.mtl\nusemtl wood\n" + text);
    workplace.write("out/square.mtl", "newmtl wood\nKd 1 1 1\nmap_Kd missing.png\n");
    const ProgramResult result =
        workplace.run(std::string("relief make out/square.obj out/a.glb") + quick);
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("missing.png"));
    EXPECT_THAT(result.out, HasSubstr("left out"));
}

TEST(MakeCommand, RefusesWhatItCannotDo) {
    const Workplace workplace;
    workplace.write("out/empty.ply", "");
    workplace.write("out/old.glb", "old");
    std::filesystem::create_directory(workplace / "in");
    std::filesystem::rename(workplace / "out/empty.ply", workplace / "in/empty.ply");
    expect_refusals(workplace, "relief", "old.glb",
                    {{"relief make in/empty.ply out/old.glb", 1, "in/empty.ply: "},
                     {"relief make none.ply out/old.glb", 1, "none.ply: no such file"},
                     {"relief make data/vase.obj out/old.obj", 2,
                      "out/old.obj: cannot hold the maps of an asset"},
                     {"relief make data/vase.obj out/old.glb --triangles 0", 2, "--triangles 0: "},
                     {"relief make data/vase.obj out/old.glb --size 8", 2, "--size 8: "},
                     {"relief make data/vase.obj out/old.glb --crease 200", 2, "--crease 200: "},
                     {"relief make data/vase.obj out/old.glb --view 30,20", 2,
                      "--view: has no effect, because no loss is measured"},
                     {"relief make data/vase.obj out/old.glb --loss --view 30", 2, "--view 30: "},
                     {"relief make data/vase.obj out/old.glb --normal-bits 12", 2,
                      "--normal-bits 12: not one of 8, 16"},
                     {"relief make data/vase.obj none/old.glb", 1,
                      "none/old.glb: the folder none does not exist"}});
}

TEST(MakeCommand, RefusesModelsThatMove) {
    const Workplace workplace;
    workplace.write_square("out/square.obj");
    ASSERT_EQ(workplace.run("relief-mesh process out/square.obj out/square.gltf").exit_code, 0);
    json document = json::parse(workplace.read("out/square.gltf"));
    document["skins"] = json::array({{{"joints", {0}}}});
    workplace.write("out/square.gltf", document.dump());
    const ProgramResult result =
        workplace.run(std::string("relief make out/square.gltf out/a.glb") + quick);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error,
                HasSubstr("has 1 skin, which an asset of one static mesh would lose"));
    EXPECT_FALSE(std::filesystem::exists(workplace / "out/a.glb"));
}

TEST_LABELS(not_sanitized);
TEST(MakeCommand, LeavesNoFileAfterAnInterruption) {
    const Workplace workplace;
    const ProgramResult result = test::run_program_until(
        {"relief", "make", "data/urn-high.ply", "out/a.glb", "--size", "4096"}, workplace / "",
        [] { return true; }, SIGINT);
    EXPECT_EQ(result.exit_code, 128 + SIGINT);
    EXPECT_EQ(workplace.outputs(), "");
}

TEST(ReliefTool, RunsTheOtherToolsWithTheirArgumentsAndExitCodes) {
    const Workplace workplace;
    const ProgramResult version = test::run_shell("relief mesh --version", workplace / "");
    EXPECT_EQ(version.exit_code, 0);
    EXPECT_THAT(version.out, HasSubstr("relief-mesh "));
    EXPECT_EQ(test::run_shell("relief mesh info none.obj", workplace / "").exit_code, 1);
    const ProgramResult usage = test::run_shell("relief mesh check --nothing", workplace / "");
    EXPECT_EQ(usage.exit_code, 2);
    EXPECT_THAT(usage.error, HasSubstr("relief-mesh"));
    const ProgramResult help = test::run_shell("relief --help", workplace / "");
    for (const char* word : {"  make ", "  mesh ", "  bake ", "  view ", "  accuracy "})
        EXPECT_THAT(help.out, HasSubstr(word));
    EXPECT_LT(std::ranges::count(help.out, '\n'), 30);
    EXPECT_EQ(test::run_shell("relief", workplace / "").exit_code, 2);
}

}  // namespace
}  // namespace relief::tools
