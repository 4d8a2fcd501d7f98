// SPDX-License-Identifier: Apache-2.0
// The commands `relief-mesh decimate` and `subdivide`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "relief/mesh/gltf_document.h"
#include "support/shared_data.h"
#include "tools/read_files.h"
#include "tools/refusal.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::read_document;
using test::Workplace;
using testing::HasSubstr;

/// Writes a wavy grid of cells x cells with two materials, left and right of x = 0.
void write_sheet(const Workplace& workplace, const std::string& name, int cells) {
    std::string vertices;
    std::string left = "usemtl left\n";
    std::string right = "usemtl right\n";
    const auto number = [&](int x, int y) { return std::to_string(y * (cells + 1) + x + 1); };
    for (int y = 0; y <= cells; ++y) {
        for (int x = 0; x <= cells; ++x) {
            const double u = double(x) / cells;
            const double v = double(y) / cells;
            vertices += "v " + std::to_string(2 * u - 1) + " " + std::to_string(2 * v - 1) + " " +
                        std::to_string(0.2 * std::sin(7 * u) * std::cos(5 * v)) + "\n";
            if (x == cells || y == cells) continue;
            (2 * x < cells ? left : right) += "f " + number(x, y) + " " + number(x + 1, y) + " " +
                                              number(x + 1, y + 1) + " " + number(x, y + 1) + "\n";
        }
    }
    workplace.write(name, vertices + left + right);
}

std::set<std::tuple<float, float, float>> places_near_the_border(const Mesh& mesh) {
    std::set<std::tuple<float, float, float>> places;
    for (const glm::vec3& p : mesh.positions) {
        if (std::abs(p.x) < 1e-6F) places.emplace(p.x, p.y, p.z);
    }
    return places;
}

/// Writes the vase with x and y as a second texture coordinate set, which its normal texture uses.
void write_vase_of_two_sets(const Workplace& workplace) {
    ASSERT_EQ(workplace.run("relief-mesh process data/vase.obj out/vase.gltf").exit_code, 0);
    json root = json::parse(workplace.read("out/vase.gltf"));
    json& primitive = root["meshes"][0]["primitives"][0];
    const json position = root["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
    json view = root["bufferViews"][position["bufferView"].get<std::size_t>()];
    view["byteStride"] = 12;
    primitive["attributes"]["TEXCOORD_1"] = root["accessors"].size();
    root["accessors"].push_back({{"bufferView", root["bufferViews"].size()},
                                 {"componentType", 5126},
                                 {"type", "VEC2"},
                                 {"count", position["count"]}});
    root["bufferViews"].push_back(view);
    root["images"] = json::parse(R"([{"uri": "data:image/png;base64,AAAA"}])");
    root["textures"] = json::parse(R"([{"source": 0}])");
    root["materials"] = json::parse(R"([{"normalTexture": {"index": 0, "texCoord": 1}}])");
    primitive["material"] = 0;
    workplace.write("out/vase.gltf", root.dump());
    ASSERT_EQ(workplace
                  .run("relief-mesh process out/vase.gltf out/two.glb --normals angle --tangents "
                       "mikktspace")
                  .exit_code,
              0);
}

TEST(DecimateCommand, NewTangentsBelongToTheNormalTexturesSet) {
    const Workplace workplace;
    write_vase_of_two_sets(workplace);
    ASSERT_EQ(
        workplace.run("relief-mesh decimate out/two.glb out/low.glb --triangles 2000").exit_code,
        0);
    const ProgramResult checked = workplace.run("relief-mesh check out/low.glb --json");
    ASSERT_EQ(checked.exit_code, 0) << checked.error;
    const json tangents = json::parse(checked.out)["files"][0]["primitives"][0]["tangents"];
    EXPECT_EQ(tangents["basis"], "mikktspace");
    EXPECT_EQ(tangents["texcoord_set_of_material"], 1);
    EXPECT_EQ(tangents["texcoord_set"], 1);
    EXPECT_EQ(tangents["corners"], tangents["agreements"][0]["agreeing"]);
}

TEST(DecimateCommand, MeetsANumberARatioAndReports) {
    const Workplace workplace;
    ProgramResult result = workplace.run(
        "relief-mesh decimate data/vase.obj out/a.glb --triangles 1000 --report out/a.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("read      data/vase.obj: Wavefront OBJ, 5760 triangles, "));
    EXPECT_THAT(result.out, HasSubstr("result    1000 triangles, "));
    EXPECT_EQ(read_document(workplace / "out/a.glb").mesh({0, 0}).triangles.size(), 1000U);
    const json report = json::parse(workplace.read("out/a.json"));
    EXPECT_EQ(report["tool"], "relief-mesh decimate");
    EXPECT_EQ(report["options"], json({{"triangles", 1000}, {"normals", "keep"}}));
    EXPECT_EQ(report["triangles_read"], 5760);
    EXPECT_EQ(report["triangles_written"], 1000);

    result = workplace.run("relief-mesh decimate data/vase.obj out/b.ply --ratio 0.25");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("result    1440 triangles, "));
    EXPECT_THAT(result.out, HasSubstr("omitted   1 material (cannot be stored in .ply)\n"));
    // The same command writes the same bytes.
    ASSERT_EQ(workplace.run("relief-mesh decimate data/vase.obj out/c.ply --ratio 0.25 --threads 1")
                  .exit_code,
              0);
    EXPECT_EQ(workplace.read("out/b.ply"), workplace.read("out/c.ply"));
}

TEST(DecimateCommand, NoGapOpensBetweenMaterials) {
    const Workplace workplace;
    write_sheet(workplace, "sheet.obj", 24);
    ASSERT_EQ(workplace.run("relief-mesh process sheet.obj out/sheet.glb").exit_code, 0);
    const ProgramResult result =
        workplace.run("relief-mesh decimate out/sheet.glb out/low.glb --ratio 0.2");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const GltfDocument document = read_document(workplace / "out/low.glb");
    ASSERT_EQ(document.triangle_primitives().size(), 2U);
    const auto left = places_near_the_border(document.mesh({0, 0}));
    EXPECT_EQ(left, places_near_the_border(document.mesh({0, 1})));
    EXPECT_GT(left.size(), 2U);
    EXPECT_LT(left.size(), 25U) << "thinned out";
}

TEST(DecimateCommand, ARiggedModelKeepsItsRigOnTheVerticesThatStay) {
    RELIEF_NEEDS_SHARED(model, "data/models/gltf/CesiumMan/glTF-Binary/CesiumMan.glb");
    const Workplace workplace;
    const ProgramResult result =
        workplace.run("relief-mesh decimate " + model.string() + " out/man.gltf --ratio 0.3");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const json root = json::parse(workplace.read("out/man.gltf"));
    const json& primitive = root["meshes"][0]["primitives"][0];
    const std::size_t count =
        root["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()]["count"];
    for (const char* name : {"JOINTS_0", "WEIGHTS_0", "TEXCOORD_0", "NORMAL"}) {
        EXPECT_EQ(root["accessors"][primitive["attributes"][name].get<std::size_t>()]["count"],
                  count)
            << name;
    }
    EXPECT_EQ(root["skins"].size(), 1U);
    const Mesh before = read_document(model).mesh({0, 0});
    const Mesh after = read_document(workplace / "out/man.gltf").mesh({0, 0});
    EXPECT_NEAR(double(after.triangles.size()), 0.3 * double(before.triangles.size()), 1.0);
}

TEST(SubdivideCommand, MakesFourOfEachAndKeepsMaterials) {
    const Workplace workplace;
    write_sheet(workplace, "sheet.obj", 6);
    ASSERT_EQ(workplace.run("relief-mesh process sheet.obj out/sheet.glb").exit_code, 0);
    const ProgramResult result = workplace.run(
        "relief-mesh subdivide out/sheet.glb out/fine.glb --levels 2 --report out/r.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("result    1152 triangles, "));
    const GltfDocument document = read_document(workplace / "out/fine.glb");
    EXPECT_EQ(document.mesh({0, 0}).triangles.size(), 576U);
    EXPECT_EQ(document.mesh({0, 1}).triangles.size(), 576U);
    EXPECT_EQ(document.view().materials.size(), 2U);
    EXPECT_EQ(places_near_the_border(document.mesh({0, 0})).size(), 25U);
    EXPECT_EQ(places_near_the_border(document.mesh({0, 0})),
              places_near_the_border(document.mesh({0, 1})));
    EXPECT_EQ(json::parse(workplace.read("out/r.json"))["options"],
              json({{"levels", 2}, {"normals", "keep"}}));
}

TEST(SubdivideCommand, ARiggedModelIsRefused) {
    RELIEF_NEEDS_SHARED(model, "data/models/gltf/CesiumMan/glTF-Binary/CesiumMan.glb");
    const Workplace workplace;
    const ProgramResult result =
        workplace.run("relief-mesh subdivide " + model.string() + " out/man.glb");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, HasSubstr("which another mesh cannot take over"));
    EXPECT_EQ(workplace.outputs(), "");
}

TEST(ReshapingRefusal, SaysWhyAndLeavesNothingBehind) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    workplace.write("flat.obj", "v 0 0 0\nv 1 0 0\nf 1 2 2\n");
    expect_refusals(
        workplace, "relief-mesh", "old.glb",
        {{"relief-mesh decimate square.obj out/old.glb", 2,
          "no limit is given (give --triangles N, --ratio R or --max-error E)"},
         {"relief-mesh decimate square.obj out/old.glb --triangles 1 --ratio 0.5", 2,
          "--triangles and --ratio contradict each other (give one of them)"},
         {"relief-mesh decimate square.obj out/old.glb --triangles 0", 2,
          "--triangles 0: not between 1 and "},
         {"relief-mesh decimate square.obj out/old.glb --ratio 1.5", 2,
          "--ratio 1.5: not between 0 and 1"},
         {"relief-mesh decimate square.obj out/old.glb --max-error -1", 2,
          "--max-error -1: not at least 0"},
         {"relief-mesh decimate missing.obj out/old.glb --ratio 0.5", 1, "missing.obj: "},
         {"relief-mesh decimate flat.obj out/old.glb --ratio 0.5", 1,
          "flat.obj: none of its triangles has an area"},
         {"relief-mesh subdivide flat.obj out/old.glb", 1,
          "flat.obj: none of its triangles has an area"},
         {"relief-mesh subdivide square.obj out/old.glb --levels 0", 2,
          "--levels 0: not between 1 and 12"},
         {"relief-mesh subdivide square.obj out/new.stl", 2,
          "out/new.stl: .stl is not a format that can be written"}});
}

}  // namespace
}  // namespace relief::tools
