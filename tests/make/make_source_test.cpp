// SPDX-License-Identifier: Apache-2.0
// The materials of dense models, from files to the asset and its report.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "make_job.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

constexpr const char* few_texels = " --triangles 400 --size 32 --padding 2 --occlusion-rays 2";

/// A glTF file of two squares with a material each, which tests may change.
json two_squares(const Workplace& workplace) {
    workplace.write("out/two.mtl", "newmtl a\nKd 1 0 0\nnewmtl b\nKd 1 0 0\n");
    workplace.write("out/two.obj",
                    "mtllib two.mtl\nv -1 -1 0\nv 0 -1 0\nv 0 1 0\nv -1 1 0\nv 1 -1 0\nv 1 1 0\n"
                    "vt 0 0\nusemtl a\nf 1/1 2/1 3/1 4/1\nusemtl b\nf 2/1 5/1 6/1 3/1\n");
    EXPECT_EQ(workplace.run("relief-mesh process out/two.obj out/two.gltf").exit_code, 0);
    return json::parse(workplace.read("out/two.gltf"));
}

make::AssetSource read(const Workplace& workplace, const json& document, Findings& findings) {
    workplace.write("out/two.gltf", document.dump());
    SourceFacts facts;
    return read_source({.files = {workplace / "out/two.gltf"}}, facts, findings);
}

std::size_t count_of(const Findings& findings, const std::string& kind) {
    std::size_t count = 0;
    for (const PlacedFinding& finding : findings.all())
        count += finding.finding.kind == kind ? finding.finding.count : 0;
    return count;
}

TEST(MakeSource, HasTheFactorsOfMaterials) {
    const Workplace workplace;
    json document = two_squares(workplace);
    document["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = 0.75;
    document["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 0.25;
    document["materials"][1]["emissiveFactor"] = {1, 0.5, 0};
    document["materials"][1]["extensions"]["KHR_materials_emissive_strength"] = {
        {"emissiveStrength", 4}};
    document["extensionsUsed"] = {"KHR_materials_emissive_strength"};
    Findings findings;
    const make::AssetSource source = read(workplace, document, findings);
    ASSERT_EQ(source.materials.size(), 2U);
    EXPECT_EQ(source.materials[0].metallic, 0.75F);
    EXPECT_EQ(source.materials[0].roughness, 0.25F);
    EXPECT_EQ(source.materials[0].emission, glm::vec3(0.0F));
    EXPECT_EQ(source.materials[1].metallic, 0.0F);
    EXPECT_EQ(source.materials[1].emission, glm::vec3(4.0F, 2.0F, 0.0F));
    EXPECT_TRUE(findings.empty());
}

TEST(MakeSource, HasTheDrawModesOfMaterials) {
    const Workplace workplace;
    json document = two_squares(workplace);
    json& materials = document["materials"];
    materials[0]["alphaMode"] = "MASK";
    materials[0]["alphaCutoff"] = 0.25;
    materials[1]["doubleSided"] = true;
    Findings findings;
    const make::AssetSource source = read(workplace, document, findings);
    EXPECT_THAT(source.draw_modes,
                testing::ElementsAre(make::DrawMode{AlphaMode::mask, 0.25F, false},
                                     make::DrawMode{AlphaMode::opaque, 0.5F, true}));
    EXPECT_TRUE(findings.empty());
}

TEST(MakeSource, KeepsFactorsOfExtensionsThatAllMaterialsShare) {
    const Workplace workplace;
    json document = two_squares(workplace);
    json& materials = document["materials"];
    for (json& material : materials)
        material["extensions"]["KHR_materials_ior"] = {{"ior", 1.25}};
    materials[0]["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 1.0}};
    materials[1]["extensions"]["KHR_materials_unlit"] = json::object();
    document["extensionsUsed"] = {"KHR_materials_ior", "KHR_materials_clearcoat",
                                  "KHR_materials_unlit"};
    Findings findings;
    const make::AssetSource source = read(workplace, document, findings);
    EXPECT_EQ(source.shared.metallic_roughness->refractive_index, 1.25F);
    EXPECT_EQ(source.shared.metallic_roughness->clearcoat, 0.0F);
    EXPECT_EQ(count_of(findings, "clearcoat of single materials"), 1U);
    EXPECT_EQ(count_of(findings, "unlit material of the source"), 1U);
    EXPECT_EQ(findings.all().size(), 2U);
}

TEST(MakeSource, HasTheMaterialsOfSeveralFiles) {
    const Workplace workplace;
    for (const char* name : {"a", "b"}) {
        const std::string file = std::string("out/") + name;
        workplace.write_square(file + ".obj");
        workplace.write(file + ".obj", std::string("mtllib ") + name + ".mtl\nusemtl m\n" +
                                           workplace.read(file + ".obj"));
    }
    workplace.write("out/a.mtl", "newmtl m\nKd 1 0 0\nNs 30\n");
    workplace.write("out/b.mtl", "newmtl m\nKd 0 1 0\nNs 0\nKe 3 0 0\n");
    SourceFacts facts;
    Findings findings;
    const DenseModel model = {.files = {workplace / "out/a.obj", workplace / "out/b.obj"}};
    const make::AssetSource source = read_source(model, facts, findings);
    EXPECT_EQ(facts.triangles, 4U);
    ASSERT_EQ(source.materials.size(), 2U);
    ASSERT_EQ(source.mesh.material_ranges.size(), 2U);
    EXPECT_EQ(source.mesh.material_ranges[1].material, 1U);
    EXPECT_EQ(source.materials[0].color, glm::vec3(1.0F, 0.0F, 0.0F));
    EXPECT_EQ(source.materials[1].color, glm::vec3(0.0F, 1.0F, 0.0F));
    // (2 / (Ns + 2))^(1/4)
    EXPECT_NEAR(source.materials[0].roughness, 0.5F, 1e-6F);
    EXPECT_EQ(source.materials[0].metallic, 0.0F);
    EXPECT_EQ(source.materials[1].roughness, 1.0F);
    EXPECT_EQ(source.materials[1].emission, glm::vec3(3.0F, 0.0F, 0.0F));
}

TEST(MakeCommandMaterials, AreInTheAssetTheFilesAndTheReport) {
    const Workplace workplace;
    json document = two_squares(workplace);
    document["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = 1;
    document["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 0.2;
    document["materials"][1]["emissiveFactor"] = {0, 0, 1};
    workplace.write("out/two.gltf", document.dump());
    const ProgramResult result =
        workplace.run(std::string("relief make out/two.gltf out/a.glb --for unreal --layers "
                                  "height,curvature --report out/a.json") +
                      few_texels);
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("occlusion, roughness, metalness 32 x 32"));
    EXPECT_THAT(result.out, HasSubstr("without a map: color (1, 0, 0)"));
    EXPECT_EQ(workplace.outputs(),
              "a.glb a.json a_E.png a_H.png a_N.png a_ORM.png a_curvature.png two.bin two.gltf "
              "two.mtl two.obj");
    const json report = json::parse(workplace.read("out/a.json"));
    std::vector<std::string> contents;
    for (const json& map : report["maps"])
        contents.push_back(map["content"]);
    EXPECT_THAT(contents, testing::ElementsAre("normals", "occlusion, roughness, metalness",
                                               "emission", "height map", "curvature"));
    EXPECT_GT(report["maps"][3]["range"], 0.0);
    EXPECT_EQ(report["material"]["base_color"], json({1.0, 0.0, 0.0}));
    EXPECT_THAT(report["command"].get<std::string>(), HasSubstr("--layers height,curvature"));
}

TEST(MakeCommandMaterials, AreThoseOfAllFilesOfAModel) {
    const Workplace workplace;
    workplace.write_square("out/a.obj");
    workplace.write("out/b.obj",
                    "v 2 -1 0\nv 4 -1 0\nv 4 1 0\nv 2 1 0\nvn 0 0 1\nf 1//1 2//1 3//1 4//1\n");
    const ProgramResult result =
        workplace.run(std::string("relief make out/a.obj out/c.glb --with out/b.obj") + few_texels);
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("out/a.obj and 1 more file: Wavefront OBJ, 4 triangles"));
    const Mesh mesh = test::read_document(workplace / "out/c.glb").mesh({0, 0});
    EXPECT_EQ(bounds_of(mesh).max.x, 4.0F);
    EXPECT_THAT(result.out, HasSubstr("1 x normals of a part beside one without (part 1)"));
    test::expect_refusals(
        workplace, "relief", "c.glb",
        {{"relief make data/vase.obj out/c.glb --with none.obj", 1, "none.obj: no such file"},
         {"relief make data/vase.obj out/c.glb --layers color", 2,
          "--layers color: not one of height, curvature, position"},
         {"relief make data/vase.obj out/c.glb --layers height,height", 2,
          "--layers height,height: height is named twice"},
         {"relief make data/vase.obj data/urn-low.obj -o out/x/ --with data/vase.obj", 2,
          "--with data/vase.obj: is a part of the model of one asset"}});
}

}  // namespace
}  // namespace relief::tools
