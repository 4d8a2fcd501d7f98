// SPDX-License-Identifier: Apache-2.0
// --write-into of relief-bake mesh and bump: finished maps in the materials of a model.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "relief/mesh/gltf_document.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::read_document;
using test::Workplace;
using testing::HasSubstr;

class WriteInto : public testing::Test {
  protected:
    WriteInto() {
        place_.write_square("low.obj");
        place_.write("high.obj",
                     "v -1 -1 0.05\nv 1 -1 0.05\nv 1 1 0.05\nv -1 1 0.05\nvn -0.48 0.36 0.8\n"
                     "f 1//1 2//1 3//1 4//1\n");
    }

    [[nodiscard]] ProgramResult bake(const std::string& words) const {
        return place_.run("relief-bake mesh high.obj " + words + " --size 16");
    }
    [[nodiscard]] json root(const std::string& file) const {
        return json::parse(place_.read(file));
    }

    const Workplace place_;
};

TEST_F(WriteInto, MakesAModelFromLowWithAllMapsOfTheBake) {
    const ProgramResult result = bake(
        "low.obj out/n.png --occlusion-map out/o.png --color-map out/c.png --write-into "
        "out/low.gltf --report out/r.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("material  'material', new\nmaps      normal: out/n.png\n"));
    EXPECT_THAT(result.out, HasSubstr("tangents  mikktspace, added to 1 primitive\n"));
    const json model = root("out/low.gltf");
    ASSERT_EQ(model["images"].size(), 3U);
    const auto image_of = [&](const json& texture) {
        const json source = model["textures"][texture["index"].get<std::size_t>()]["source"];
        return model["images"][source.get<std::size_t>()]["uri"].get<std::string>();
    };
    const json& material = model["materials"][0];
    EXPECT_EQ(image_of(material["normalTexture"]), "n.png");
    EXPECT_EQ(image_of(material["occlusionTexture"]), "o.png");
    EXPECT_EQ(image_of(material["pbrMetallicRoughness"]["baseColorTexture"]), "c.png");
    EXPECT_TRUE(model["meshes"][0]["primitives"][0]["attributes"].contains("TANGENT"));
    EXPECT_EQ(root("out/r.json")["stored"]["primitives_with_new_tangents"], 1);
    // The model shows the map as it was baked, and the model is sound.
    EXPECT_EQ(place_.run("relief-bake check out/n.png --high high.obj --low out/low.gltf --strict")
                  .exit_code,
              0);
    EXPECT_EQ(place_.run("relief-mesh check out/low.gltf --strict").exit_code, 0);
}

TEST_F(WriteInto, ModelsWithoutNormalsGetThoseOfTheBake) {
    place_.write("bent.obj",
                 "v -1 -1 0\nv 1 -1 0\nv 1 1 0.4\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                 "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n");
    ASSERT_EQ(bake("bent.obj out/n.png --write-into out/bent.gltf").exit_code, 0);
    ASSERT_EQ(place_.run("relief-mesh process bent.obj out/processed.gltf").exit_code, 0);
    const auto normals_of = [&](const char* file) {
        const GltfDocument document = read_document(place_ / file);
        return document.mesh({0, 0}).normals;
    };
    const std::vector<glm::vec3> normals = normals_of("out/bent.gltf");
    EXPECT_EQ(normals.size(), 4U) << "averaged normals split no vertex";
    EXPECT_EQ(normals, normals_of("out/processed.gltf"));
}

TEST_F(WriteInto, ReplacesTheMapsOfLowItselfAndShowsThemAsTheyAre) {
    ASSERT_EQ(bake("low.obj out/n.png --color-map out/c.png --write-into out/low.gltf").exit_code,
              0);
    json before = root("out/low.gltf");
    json& material = before["materials"][0];
    material["normalTexture"]["scale"] = 0.25;
    material["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 0.5, 0.5, 0.75};
    before["extras"] = "kept";
    place_.write("out/low.gltf", before.dump());
    const ProgramResult result =
        bake("out/low.gltf out/n2.png --color-map out/c2.png --write-into out/low.gltf --embed");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("1 x base color factor of a material with baked colors "
                                      "(material 0): multiplies them"));
    const json after = root("out/low.gltf");
    const json& changed = after["materials"][0];
    EXPECT_EQ(changed["normalTexture"]["scale"], 1);
    EXPECT_EQ(after["extras"], "kept");
    ASSERT_EQ(after["images"].size(), 2U);
    EXPECT_TRUE(after["images"][0].contains("bufferView"));
    // A transform would show the map at another place.
    json moved = after;
    moved["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"]["scale"] = {2, 2};
    moved["extensionsUsed"] = {"KHR_texture_transform"};
    place_.write("out/low.gltf", moved.dump());
    const ProgramResult refused = bake("out/low.gltf out/n3.png --write-into out/low.gltf");
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_THAT(refused.error, HasSubstr("has KHR_texture_transform, which would move the baked"));
}

TEST_F(WriteInto, TransparentColorsStayTransparent) {
    place_.write("high.obj",
                 "mtllib high.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nusemtl glass\n"
                 "f 1 2 3 4\n");
    place_.write("high.mtl", "newmtl glass\nKd 1 0.5 0.25\nd 0.25\n");
    const std::string line =
        "relief-bake mesh out/high.gltf low.obj out/n.png --size 16 --color-map out/c.png "
        "--write-into ";
    ASSERT_EQ(place_.run("relief-mesh process high.obj out/high.gltf").exit_code, 0);
    const auto alpha_of = [&](const std::string& model) {
        const json material = root(model)["materials"][0];
        return std::pair(material.value("alphaMode", "OPAQUE"), material.value("alphaCutoff", 0.5));
    };
    // An opaque material becomes transparent like those of the high model, and says so.
    ProgramResult result = place_.run(line + "out/low.gltf");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("1 x opaque material with transparent baked colors (material "
                                      "0): gets the alpha mode BLEND"));
    EXPECT_EQ(alpha_of("out/low.gltf"), std::pair(std::string("BLEND"), 0.5));
    EXPECT_EQ(read_image(place_ / "out/c.png", ImageUse::color).channels, 4);
    EXPECT_EQ(place_.run("relief-mesh check out/low.gltf --strict").exit_code, 0);
    // One that is transparent already keeps its mode.
    result = place_.run(line + "out/low.gltf");
    EXPECT_EQ(result.out.find("opaque material"), std::string::npos);
    // Cutouts stay cutouts.
    json high = root("out/high.gltf");
    high["materials"][0]["alphaMode"] = "MASK";
    high["materials"][0]["alphaCutoff"] = 0.125;
    place_.write("out/high.gltf", high.dump());
    ASSERT_EQ(place_.run(line + "out/mask.gltf").exit_code, 0);
    EXPECT_EQ(alpha_of("out/mask.gltf"), std::pair(std::string("MASK"), 0.125));
    // Opaque materials change nothing.
    high["materials"][0].erase("alphaMode");
    high["materials"][0].erase("alphaCutoff");
    place_.write("out/high.gltf", high.dump());
    ASSERT_EQ(place_.run(line + "out/opaque.gltf").exit_code, 0);
    EXPECT_EQ(alpha_of("out/opaque.gltf"), std::pair(std::string("OPAQUE"), 0.5));
    EXPECT_EQ(read_image(place_ / "out/c.png", ImageUse::color).channels, 3);
}

TEST_F(WriteInto, EachMaterialGetsItsMap) {
    place_.write("low.obj",
                 "mtllib low.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
                 "vt 0 1\nusemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 3/3 4/4\n");
    place_.write("low.mtl", "newmtl a\nnewmtl b\n");
    ASSERT_EQ(bake("low.obj 'out/<material>.png' --write-into out/low.gltf").exit_code, 0);
    const json model = root("out/low.gltf");
    ASSERT_EQ(model["materials"].size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        const std::size_t texture =
            model["materials"][i]["normalTexture"]["index"].get<std::size_t>();
        const std::size_t image = model["textures"][texture]["source"].get<std::size_t>();
        EXPECT_EQ(model["images"][image]["uri"],
                  model["materials"][i]["name"].get<std::string>() + ".png");
    }
    // A single map belongs to both.
    ASSERT_EQ(bake("low.obj out/both.png --write-into out/both.gltf").exit_code, 0);
    const json both = root("out/both.gltf");
    EXPECT_EQ(both["images"].size(), 1U);
    EXPECT_EQ(both["materials"][0]["normalTexture"], both["materials"][1]["normalTexture"]);
}

TEST_F(WriteInto, StoresTheMapOfBumpWithItsScale) {
    ASSERT_EQ(place_.run("relief-mesh process low.obj out/wall.glb").exit_code, 0);
    place_.write_bricks("h.png");
    const ProgramResult result = place_.run(
        "relief-bake bump h.png out/n.png --kernel central3 --for gltf --write-into out/wall.glb "
        "--scale 0.5 --material brick");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("material  'brick', new\n"));
    const GltfView view = read_document(place_ / "out/wall.glb").view();
    ASSERT_EQ(view.materials.size(), 1U);
    ASSERT_TRUE(view.materials[0].normal_map);
    EXPECT_EQ(view.materials[0].normal_map->scale, 0.5F);
    EXPECT_FALSE(read_document(place_ / "out/wall.glb").mesh({0, 0}).tangents.empty());
}

TEST_F(WriteInto, AFailureWritesNeitherMapsNorModel) {
    ASSERT_EQ(place_.run("relief-mesh process low.obj out/wall.glb").exit_code, 0);
    const std::string before = place_.read("out/wall.glb");
    ASSERT_EQ(place_
                  .run("relief-mesh material out/wall.glb out/wall.glb --material a --normal " +
                       test::bricks_map)
                  .exit_code,
              0);
    const std::string with_map = place_.read("out/wall.glb");
    EXPECT_NE(with_map, before);
    const ProgramResult result = bake("low.obj out/n.png --write-into out/wall.glb --material b");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, HasSubstr("out/wall.glb: has no material 'b' (available: 'a')\n"));
    EXPECT_EQ(place_.read("out/wall.glb"), with_map);
    EXPECT_EQ(place_.outputs(), "wall.glb");
}

TEST_F(WriteInto, RefusesMapsThatGltfCannotShow) {
    const std::string line = "relief-bake mesh high.obj low.obj ";
    expect_refusals(
        place_, "relief-bake", "old.png",
        {{line + "out/n.exr --write-into out/m.glb", 2,
          "--write-into: glTF cannot store out/n.exr"},
         {line + "out/n.png --occlusion-map out/o.tif --write-into out/m.glb", 2,
          "--write-into: glTF cannot store out/o.tif (use a .png)"},
         {line + "out/n.png --green down --write-into out/m.glb", 2,
          "--green, --write-into: glTF has green up"},
         {line + "out/n.png --for unreal --write-into out/m.glb", 2,
          "--green, --write-into: glTF has green up"},
         {line + "out/n.png --space object --write-into out/m.glb", 2,
          "--space, --write-into: normals of glTF are in tangent space"},
         {line + "'out/<UDIM>.png' --write-into out/m.glb", 2,
          "<UDIM>, --write-into: a material of glTF has one image"},
         {line + "out/n.png --write-into out/m.obj", 2,
          "--write-into out/m.obj: cannot store materials of glTF (write a .glb or .gltf)"},
         {line + "out/n.png --write-into high.obj", 2,
          "--write-into high.obj: cannot store materials of glTF"},
         {line + "out/n.png --material a", 2, "--material: has no effect without --write-into"},
         {"relief-bake bump data/bricks-height.png out/n.png --write-into out/none.glb", 1,
          "out/none.glb: does not exist"},
         {"relief-bake bump data/bricks-height.png out/n.png --scale 2", 2,
          "--scale: has no effect without --write-into"}});
}

}  // namespace
}  // namespace relief::tools
