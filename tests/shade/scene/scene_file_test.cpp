// SPDX-License-Identifier: Apache-2.0
// Scenes from model files, environment folders, image sources and the means of textures.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>
#include <vector>

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_file.h"
#include "relief/shade/scene_graph.h"
#include "scene/scene_parts.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::shade;
using namespace relief::shade::detail;

namespace {

using ::testing::HasSubstr;

void write_text(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file) << text;
}

constexpr const char* two_triangles =
    "mtllib paint.mtl\n"
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "usemtl paint\nf 1/1 2/2 3/3\nusemtl glow\nf 1/1 3/3 4/4\n";

TEST(LoadScene, ReadsObjWithItsMaterials) {
    const test::TemporaryDirectory folder;
    write_text(folder / "model.obj", two_triangles);
    write_text(folder / "paint.mtl",
               "newmtl paint\nKa 0.1 0.1 0.1\nKd 0.5 0.6 0.7\nKs 0.2 0.3 0.4\nNs 40\nillum 2\n"
               "map_Kd missing.png\nnorm missing_too.png\n"
               "newmtl glow\nKe 0 0 0\nmap_Ke glow.png\nmap_bump -bm 0.5 heights.png\nd 0.5\n"
               "map_Ks shine.png\nmap_d holes.png\nmap_Ns gloss.png\n");
    Report report;
    const Scene scene = load_scene(folder / "model.obj", report);
    ASSERT_EQ(scene.materials.size(), 2U);
    const Material& paint = scene.materials[0];
    EXPECT_EQ(paint.name, "paint");
    EXPECT_EQ(paint.diffuse, glm::vec3(0.5F, 0.6F, 0.7F));
    EXPECT_EQ(paint.shininess, 40.0F);
    ASSERT_TRUE(paint.diffuse_texture && paint.normal_map);
    // A missing image has no effect until it is needed.
    EXPECT_EQ(std::get<std::filesystem::path>(scene.images[paint.diffuse_texture->image].source),
              folder / "missing.png");
    EXPECT_EQ(paint.normal_map->green, Green::up);
    const Material& glow = scene.materials[1];
    EXPECT_EQ(glow.emission, glm::vec3(1.0F));  // The map is used unchanged.
    EXPECT_EQ(glow.specular, glm::vec3(1.0F));  // The map is used unchanged.
    EXPECT_EQ(glow.alpha_mode, AlphaMode::blend);
    EXPECT_EQ(glow.opacity, 0.5F);
    ASSERT_TRUE(glow.bump_map && glow.specular_texture && glow.opacity_texture);
    EXPECT_EQ(glow.bump_map->strength, 8.0F);  // Half of 16 texels.
    EXPECT_EQ(scene.images[glow.opacity_texture->image].name, (folder / "holes.png").string());
    EXPECT_FALSE(glow.unlit);  // Without an illum statement, the model is 2.
    EXPECT_EQ(paint.alpha_mode, AlphaMode::opaque);
    EXPECT_EQ(report.count("map_Ns in MTL"), 1U);
    EXPECT_EQ(report.findings().size(), 1U);
    ASSERT_EQ(scene.meshes.size(), 1U);
    EXPECT_EQ(scene.meshes[0]->normals.size(), scene.meshes[0]->positions.size());
    EXPECT_TRUE(scene.meshes[0]->tangents.empty());
    EXPECT_FALSE(scene.camera);
    EXPECT_TRUE(scene.directional_lights.empty());
}

TEST(LoadScene, RefusesSizesThatNoCameraShows) {
    const test::TemporaryDirectory folder;
    write_text(folder / "model.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1e30 0\nf 1 2 3\n");
    try {
        (void)load_scene(folder / "model.obj");
        FAIL() << "the model is loaded";
    } catch (const FileError& error) {
        EXPECT_EQ(std::string(error.what()),
                  (folder / "model.obj").string() +
                      ": instance 'model': reaches up to 1e+30 in the world, but pictures show "
                      "coordinates up to 1e+18 (scale it)");
    }
    write_text(folder / "model.obj", "v 0 0 0\nv 9e17 0 0\nv 0 9e17 0\nf 1 2 3\n");
    EXPECT_TRUE(is_finite(glm::vec3(
        framed(load_scene(folder / "model.obj"), 0.6F, 0.35F, 0.7F, 1.0F).world_from_view[3])));
}

/// A roof of two triangles with normals (1,0,1) and (-1,0,1) and its ridge along y, as STL.
constexpr const char* roof_stl =
    "solid roof\n"
    "facet normal 1 0 1\nouter loop\nvertex 0 0 1\nvertex 1 0 0\nvertex 0 1 1\nendloop\nendfacet\n"
    "facet normal -1 0 1\nouter loop\nvertex 0 0 1\nvertex 0 1 1\nvertex -1 0 "
    "0\nendloop\nendfacet\n"
    "endsolid roof\n";

TEST(LoadScene, KeepsTheEdgesOfPartsHard) {
    const test::TemporaryDirectory folder;
    write_text(folder / "roof.stl", roof_stl);
    const float half = std::sqrt(0.5F);
    const auto first_normal = [&](const SceneOptions& options) {
        const Scene scene = load_scene(folder / "roof.stl", options);
        return scene.meshes[0]->normals[scene.meshes[0]->triangles[0].x];
    };
    EXPECT_LT(glm::distance(first_normal({}), glm::vec3(half, 0.0F, half)), 1e-6F);
    EXPECT_LT(glm::distance(first_normal({.crease_angle = 1.6}), glm::vec3(0.0F, 0.0F, 1.0F)),
              1e-6F)
        << "the edge of 90 degrees is smooth";
    EXPECT_LT(glm::distance(first_normal({.normals = NormalMode::flat, .crease_angle = 1.6}),
                            glm::vec3(half, 0.0F, half)),
              1e-6F);
}

TEST(LoadScene, TurnsTheUpAxisOfAModelUp) {
    const test::TemporaryDirectory folder;
    write_text(folder / "roof.stl", roof_stl);
    write_text(folder / "flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 5\nf 1 2 3\n");
    const auto top = [&](const char* file, UpAxis up) {
        return world_bounds(load_scene(folder / file, {.up = up})).max;
    };
    EXPECT_EQ(top("roof.stl", UpAxis::automatic), glm::vec3(1.0F, 1.0F, 0.0F)) << "z is up";
    EXPECT_EQ(top("roof.stl", UpAxis::y), glm::vec3(1.0F, 1.0F, 1.0F));
    EXPECT_EQ(top("flat.obj", UpAxis::automatic), glm::vec3(1.0F, 1.0F, 5.0F));
    EXPECT_EQ(top("flat.obj", UpAxis::z), glm::vec3(1.0F, 5.0F, 0.0F));
}

TEST(LoadScene, ReportsMaterialExtensionsThatAreNotDrawn) {
    const test::TemporaryDirectory folder;
    const auto load = [&](const std::string& materials, const std::string& more) {
        write_text(folder / "m.gltf", R"({"asset": {"version": "2.0"}, "materials": [)" +
                                          materials + "]" + more + "}");
        Report report;
        Scene scene = load_scene(folder / "m.gltf", report);
        return std::pair(std::move(scene), report);
    };
    const auto [neutral, nothing] = load(
        R"({"extensions": {"KHR_materials_clearcoat": {}, "KHR_materials_ior": {"ior": 1.5},
            "KHR_materials_sheen": {"sheenColorFactor": [0, 0, 0]},
            "KHR_materials_specular": {"specularFactor": 1.0},
            "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0},
            "KHR_materials_emissive_strength": {"emissiveStrength": 3}}})",
        "");
    EXPECT_TRUE(nothing.empty()) << "these values change nothing";
    EXPECT_TRUE(neutral.materials[0].undrawn_extensions.empty());
    const auto [scene, report] = load(
        R"({"extensions": {"KHR_materials_volume_scatter": {}}},
           {"extensions": {"KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.5},
                           "KHR_materials_volume_scatter": {}}})",
        R"(, "extensionsUsed": ["KHR_materials_diffuse_transmission", "KHR_materials_volume_scatter"],
           "extensionsRequired": ["KHR_materials_diffuse_transmission"])");
    EXPECT_EQ(report.count("KHR_materials_volume_scatter"), 2U);
    EXPECT_EQ(report.count("KHR_materials_diffuse_transmission, which the file requires"), 1U);
    EXPECT_THAT(
        scene.materials[1].undrawn_extensions,
        testing::ElementsAre("KHR_materials_diffuse_transmission", "KHR_materials_volume_scatter"));
    const auto [drawn, all_drawn] = load(
        R"({"extensions": {"KHR_materials_ior": {"ior": 0.5}, "KHR_materials_specular":
                {"specularFactor": 0.25, "specularColorFactor": [2, 1, -1]},
                 "KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1], "sheenRoughnessFactor": 2}}},
           {"extensions": {"KHR_materials_ior": {"ior": 0}}})",
        R"(, "extensionsUsed": ["KHR_materials_ior", "KHR_materials_specular", "KHR_materials_sheen"],
           "extensionsRequired": ["KHR_materials_sheen"])");
    EXPECT_TRUE(all_drawn.empty()) << "factors are drawn";
    EXPECT_EQ(drawn.materials[0].metallic_roughness->sheen_roughness, 1.0F);
    const MetallicRoughness& model = *drawn.materials[0].metallic_roughness;
    EXPECT_EQ(model.refractive_index, 1.0F) << "the nearest allowed index";
    EXPECT_EQ(model.specular, 0.25F);
    EXPECT_EQ(model.specular_color, glm::vec3(2, 1, 0));
    EXPECT_EQ(drawn.materials[1].metallic_roughness->refractive_index, 0.0F);
    const auto [layered, none] = load(
        R"({"extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 2},
                           "KHR_materials_anisotropy": {"anisotropyStrength": 3, "anisotropyRotation": -2},
                           "KHR_materials_iridescence": {"iridescenceFactor": 0.5, "iridescenceIor": 0.5,
                                                         "iridescenceThicknessMaximum": -1},
                           "KHR_materials_transmission": {"transmissionFactor": 2},
                           "KHR_materials_volume": {"thicknessFactor": -1, "attenuationDistance": 0,
                                                    "attenuationColor": [2, 0.5, -1]},
                           "KHR_materials_sheen": {"sheenColorFactor": [0, 0.5, 0]}}})",
        "");
    EXPECT_TRUE(none.empty());
    EXPECT_EQ(layered.materials[0].metallic_roughness->transmission, 1.0F);
    EXPECT_EQ(layered.materials[0].metallic_roughness->thickness, 0.0F);
    EXPECT_EQ(layered.materials[0].metallic_roughness->attenuation_distance, 1e-30F);
    EXPECT_EQ(layered.materials[0].metallic_roughness->attenuation_color, glm::vec3(1, 0.5F, 0));
    EXPECT_EQ(layered.materials[0].metallic_roughness->iridescence, 0.5F);
    EXPECT_EQ(layered.materials[0].metallic_roughness->iridescence_index, 1.0F);
    EXPECT_EQ(layered.materials[0].metallic_roughness->iridescence_thickness, 0.0F);
    EXPECT_EQ(layered.materials[0].metallic_roughness->anisotropy, 1.0F);
    EXPECT_EQ(layered.materials[0].metallic_roughness->anisotropy_rotation, -2.0F);
    EXPECT_EQ(layered.materials[0].metallic_roughness->clearcoat, 1.0F);
    EXPECT_EQ(layered.materials[0].metallic_roughness->sheen_color, glm::vec3(0, 0.5F, 0));
    Report report_of_phong;
    const Scene phong = load_scene(folder / "m.gltf", {.model = SceneOptions::MaterialModel::phong},
                                   report_of_phong);
    EXPECT_EQ(report_of_phong.count("KHR_materials_clearcoat"), 1U) << "Phong has no layers";
    EXPECT_EQ(report_of_phong.count("KHR_materials_sheen"), 1U);
    EXPECT_EQ(report_of_phong.count("KHR_materials_transmission"), 1U);
    EXPECT_EQ(report_of_phong.count("KHR_materials_anisotropy"), 1U);
    EXPECT_EQ(report_of_phong.count("KHR_materials_iridescence"), 1U);
}

TEST(LoadScene, AnimatesNumbersThatPointersName) {
    const test::TemporaryDirectory folder;
    const std::vector<float> keys = {0, 2, 0, 0, 0, 0, 1, 0.5F, 0.25F, 0.75F};  // Times and colors.
    std::ofstream(folder / "k.bin", std::ios::binary)
        .write(reinterpret_cast<const char*>(keys.data()),
               static_cast<std::streamsize>(4 * keys.size()));
    std::string channels;
    const auto add = [&](const std::string& pointer, int sampler) {
        channels += fmt::format(
            R"({}{{"sampler": {}, "target": {{"path": "pointer", "extensions":
               {{"KHR_animation_pointer": {{"pointer": "{}"}}}}}}}})",
            channels.empty() ? "" : ",", sampler, pointer);
    };
    add("/materials/0/pbrMetallicRoughness/baseColorFactor", 0);
    add("/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor", 1);
    add("/materials/1/extensions/KHR_materials_emissive_strength/emissiveStrength", 1);
    add("/materials/2/emissiveFactor", 0);
    add("/materials/2/pbrMetallicRoughness/baseColorFactor", 0);
    add("/extensions/KHR_lights_punctual/lights/1/color", 0);
    add("/cameras/0/perspective/yfov", 1);
    add("/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/"
        "offset",
        1);
    add("/materials/9/alphaCutoff", 1);
    add("/cameras/0/perspective/aspectRatio", 1);
    add("/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle", 1);
    write_text(folder / "m.gltf", R"({"asset": {"version": "2.0"},
      "extensionsUsed": ["KHR_animation_pointer", "KHR_lights_punctual", "KHR_materials_clearcoat",
                         "KHR_materials_emissive_strength", "KHR_materials_unlit"],
      "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional"},
                     {"type": "point", "intensity": 3.14159265}]}},
      "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1, "zfar": 9}}],
      "nodes": [{"extensions": {"KHR_lights_punctual": {"light": 0}}},
                {"extensions": {"KHR_lights_punctual": {"light": 1}}},
                {"extensions": {"KHR_lights_punctual": {"light": 1}}}, {"camera": 0}],
      "materials": [{}, {"emissiveFactor": [1, 0.5, 0]},
                    {"extensions": {"KHR_materials_unlit": {},
                                    "KHR_materials_emissive_strength": {"emissiveStrength": 4}}}],
      "buffers": [{"uri": "k.bin", "byteLength": 40}],
      "bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 32}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR"},
                    {"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC4"}],
      "animations": [{"samplers": [{"input": 0, "output": 1}, {"input": 0, "output": 0}],
                      "channels": [)" +
                                      channels + "]}]}");
    Report report;
    SceneGraph graph = load_scene_graph(folder / "m.gltf", {}, report);
    EXPECT_EQ(report.count("animated property that is not drawn"), 4U);
    EXPECT_EQ(report.count("animated value outside of its range"), 1U) << "a clear coat of 2";
    EXPECT_NO_THROW(validate(graph));
    pose(graph, 1.0);
    const Scene& scene = graph.scene;
    EXPECT_EQ(scene.materials[0].metallic_roughness->base_color, glm::vec3(0.5F, 0.25F, 0.125F));
    EXPECT_EQ(scene.materials[0].opacity, 0.375F);
    EXPECT_EQ(scene.materials[0].metallic_roughness->clearcoat, 1.0F);
    EXPECT_EQ(scene.materials[1].emission, glm::vec3(1, 0.5F, 0));
    EXPECT_EQ(scene.materials[2].emission, glm::vec3(2, 1, 0.5F)) << "times the strength";
    EXPECT_EQ(scene.materials[2].diffuse, glm::vec3(0.5F, 0.25F, 0.125F)) << "unlit";
    ASSERT_EQ(scene.point_lights.size(), 2U);
    for (const PointLight& light : scene.point_lights)
        EXPECT_NEAR(light.intensity.r, 0.5F, 1e-6F) << "both nodes have this light";
    EXPECT_EQ(scene.camera->vertical_fov, 1.0F);
}

TEST(LoadScene, HasTheTexturesOfMaterialExtensions) {
    const test::TemporaryDirectory folder;
    write_text(folder / "m.gltf", R"({"asset": {"version": "2.0"}, "images": [
        {"uri": "0.png"}, {"uri": "1.png"}, {"uri": "2.png"}, {"uri": "3.png"}, {"uri": "4.png"},
        {"uri": "5.png"}, {"uri": "6.png"}, {"uri": "7.png"}, {"uri": "8.png"}, {"uri": "9.png"}, {"uri": "10.png"},
        {"uri": "11.png"}],
      "textures": [{"source": 0}, {"source": 1}, {"source": 2}, {"source": 3}, {"source": 4},
        {"source": 5}, {"source": 6}, {"source": 7}, {"source": 8}, {"source": 9}, {"source": 10},
        {"source": 11}],
      "materials": [{"extensions": {
        "KHR_materials_transmission": {"transmissionFactor": 1, "transmissionTexture": {"index": 9}},
        "KHR_materials_volume": {"thicknessFactor": 1, "thicknessTexture": {"index": 10}},
        "KHR_materials_specular": {"specularTexture": {"index": 0}, "specularColorTexture": {"index": 1}},
        "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatTexture": {"index": 2},
            "clearcoatRoughnessTexture": {"index": 3}, "clearcoatNormalTexture": {"index": 4, "scale": 0.5}},
        "KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1], "sheenColorTexture": {"index": 5},
            "sheenRoughnessTexture": {"index": 11}},
        "KHR_materials_anisotropy": {"anisotropyStrength": 1, "anisotropyTexture": {"index": 6}},
        "KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceThicknessMinimum": 200,
            "iridescenceTexture": {"index": 7}, "iridescenceThicknessTexture": {"index": 8}}}}]})");
    Report report;
    const Scene scene = load_scene(folder / "m.gltf", report);
    EXPECT_TRUE(scene.materials[0].undrawn_extensions.empty());
    const MetallicRoughness& model = *scene.materials[0].metallic_roughness;
    const std::optional<Texture> textures[] = {model.specular_texture,
                                               model.specular_color_texture,
                                               model.clearcoat_texture,
                                               model.clearcoat_roughness_texture,
                                               model.clearcoat_normal_map->texture,
                                               model.sheen_color_texture,
                                               model.anisotropy_texture,
                                               model.iridescence_texture,
                                               model.iridescence_thickness_texture,
                                               model.transmission_texture,
                                               model.thickness_texture,
                                               model.sheen_roughness_texture};
    for (std::size_t i = 0; i < std::size(textures); ++i) {
        ASSERT_TRUE(textures[i]) << i;
        EXPECT_EQ(textures[i]->image, i);
    }
    EXPECT_EQ(model.clearcoat_normal_map->scale, 0.5F);
    EXPECT_EQ(model.iridescence_thickness_minimum, 200.0F);
    EXPECT_EQ(model.iridescence_thickness, 400.0F);
}

TEST(LoadScene, UsesAlphaOfTheDiffuseMapAsOpacity) {
    const test::TemporaryDirectory folder;
    write_text(folder / "model.obj", two_triangles);
    write_text(folder / "paint.mtl",
               "newmtl paint\nmap_Kd leaf.png\nmap_d leaf.png\nmap_Ka leaf.png\nnewmtl glow\n"
               "norm n.png\nbump h.png\n");
    Report report;
    const Scene scene = load_scene(folder / "model.obj", report);
    EXPECT_EQ(scene.materials[0].alpha_mode, AlphaMode::blend);
    EXPECT_TRUE(scene.materials[0].diffuse_texture);
    EXPECT_FALSE(scene.materials[0].opacity_texture);
    // The model supports one normal, so it uses one of both maps.
    EXPECT_TRUE(scene.materials[1].normal_map);
    EXPECT_FALSE(scene.materials[1].bump_map);
    EXPECT_EQ(report.count("bump map beside a normal map"), 1U);
    EXPECT_EQ(report.findings().size(), 1U);
}

TEST(LoadScene, GivesSurfacesWithoutMaterialBothSides) {
    const test::TemporaryDirectory folder;
    write_text(folder / "model.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    Report report;
    const Scene scene = load_scene(folder / "model.obj", report);
    ASSERT_EQ(scene.materials.size(), 1U);
    EXPECT_TRUE(scene.materials[0].double_sided);
    EXPECT_EQ(scene.meshes[0]->material_ranges,
              (std::vector<MaterialRange>{{0, 1, std::uint32_t{0}}}));
    EXPECT_EQ(scene.meshes[0]->normals[0], glm::vec3(0, 0, 1));
}

/// One triangle with lights, a camera below a scaled node, and a material with all members.
std::string lit_triangle() {
    return R"({
  "asset": {"version": "2.0"},
  "extensionsUsed": ["KHR_lights_punctual", "KHR_texture_transform"],
  "extensions": {"KHR_lights_punctual": {"lights": [
    {"type": "directional", "color": [1, 0.5, 0], "intensity": 3.14159265},
    {"type": "point", "intensity": 6.2831853, "range": 5},
    {"type": "spot", "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.4}}]}},
  "scene": 0,
  "scenes": [{"nodes": [0, 1, 2, 3, 4]}],
  "nodes": [
    {"mesh": 0, "name": "first", "translation": [2, 0, 0]},
    {"mesh": 0, "name": "second", "scale": [-1, 1, 1]},
    {"extensions": {"KHR_lights_punctual": {"light": 0}}, "rotation": [-0.70710678, 0, 0, 0.70710678]},
    {"translation": [1, 2, 3], "children": [5, 6]},
    {"camera": 0, "translation": [0, 0, 7], "scale": [2, 3, 4]},
    {"extensions": {"KHR_lights_punctual": {"light": 1}}},
    {"extensions": {"KHR_lights_punctual": {"light": 2}}}],
  "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.25}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_1": 2}, "indices": 1, "material": 0}]}],
  "materials": [{"name": "glass", "alphaMode": "BLEND", "doubleSided": true,
    "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.5,
      "baseColorFactor": [0.5, 0.25, 1, 0.75],
      "baseColorTexture": {"index": 0, "texCoord": 1,
        "extensions": {"KHR_texture_transform": {"scale": [2, 3], "offset": [0.5, 0]}}},
      "metallicRoughnessTexture": {"index": 0, "texCoord": 1,
        "extensions": {"KHR_texture_transform": {"scale": [2, 3], "offset": [0.5, 0]}}}},
    "occlusionTexture": {"index": 0, "strength": 0.25},
    "emissiveTexture": {"index": 0, "texCoord": 1},
    "normalTexture": {"index": 0, "scale": 0.5, "texCoord": 1,
      "extensions": {"KHR_texture_transform": {"scale": [2, 3], "offset": [0.5, 0]}}}}],
  "textures": [{"source": 0}],
  "images": [{"uri": "missing.png"}],
  "accessors": [
    {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
    {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
    {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC2"}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
  "buffers": [{"byteLength": 42, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA"}]
})";
}

TEST(LoadScene, TransformsContentOfGltfFiles) {
    const test::TemporaryDirectory folder;
    write_text(folder / "lit.gltf", lit_triangle());
    Report report;
    const Scene scene = load_scene(folder / "lit.gltf", report);
    ASSERT_EQ(scene.meshes.size(), 1U);  // Two nodes use the mesh, and it is read once.
    ASSERT_EQ(scene.instances.size(), 2U);
    EXPECT_EQ(scene.instances[0].name, "first");
    EXPECT_EQ(scene.instances[0].world_from_object[3], glm::vec4(2, 0, 0, 1));
    EXPECT_EQ(scene.instances[1].world_from_object[0].x, -1.0F);
    EXPECT_EQ(scene.meshes[0]->normals[0], glm::vec3(0, 0, 1));  // Flat normals, as glTF requires.

    ASSERT_EQ(scene.directional_lights.size(), 1U);
    const DirectionalLight& sun = scene.directional_lights[0];
    EXPECT_NEAR(sun.direction_world.y, -1.0F, 1e-6F);  // Its node is rotated and looks down.
    EXPECT_NEAR(sun.irradiance.x, 1.0F, 1e-6F);        // pi lux divided by pi.
    EXPECT_NEAR(sun.irradiance.y, 0.5F, 1e-6F);
    ASSERT_EQ(scene.point_lights.size(), 1U);
    EXPECT_EQ(scene.point_lights[0].position_world, glm::vec3(1, 2, 3));
    EXPECT_NEAR(scene.point_lights[0].intensity.x, 2.0F, 1e-6F);
    EXPECT_EQ(scene.point_lights[0].range, 5.0F);
    ASSERT_EQ(scene.spot_lights.size(), 1U);
    EXPECT_EQ(scene.spot_lights[0].direction_world, glm::vec3(0, 0, -1));
    EXPECT_NEAR(scene.spot_lights[0].outer_cone, 0.4F, 1e-6F);

    ASSERT_TRUE(scene.camera);
    // The scale does not change the view.
    EXPECT_EQ(scene.camera->world_from_view[1], glm::vec4(0, 1, 0, 0));
    EXPECT_EQ(scene.camera->world_from_view[3], glm::vec4(0, 0, 7, 1));
    EXPECT_EQ(scene.camera->near, 0.25F);
    EXPECT_GT(scene.camera->far, 7.0F);  // The file has no far distance, so it is that of the
                                         // scene.
    EXPECT_LT(scene.camera->far, 10.0F);
}

TEST(LoadScene, TurnsStoredTangentsWithTheTexture) {
    // A square whose tangents, along x, belong to the stored coordinates. The transform rotates the
    // image clockwise by 90 degrees and mirrors it.
    MeshFile square;
    square.mesh = make_quad();
    square.mesh.tangents.assign(4, glm::vec4(1, 0, 0, 1));
    const test::TemporaryDirectory folder;
    GltfDocument document = GltfDocument::from_mesh(square);
    FramedMesh framed;
    framed.mesh = square.mesh;
    framed.source_vertex = {0, 1, 2, 3};
    document.set_frames(document.triangle_primitives().front(), framed);
    document.write(folder / "square.gltf");
    std::ifstream stream(folder / "square.gltf");
    nlohmann::json root = nlohmann::json::parse(stream);
    root["images"] = nlohmann::json::parse(R"([{"uri": "data:image/png;base64,AAAA"}])");
    root["textures"] = nlohmann::json::parse(R"([{"source": 0}])");
    root["materials"] = nlohmann::json::parse(R"([{"normalTexture": {"index": 0, "extensions":
        {"KHR_texture_transform": {"rotation": 1.5707963267948966, "scale": [1, -1]}}}}])");
    root["meshes"][0]["primitives"][0]["material"] = 0;
    write_text(folder / "square.gltf", root.dump());
    Report report;
    const Scene scene = load_scene(folder / "square.gltf", report);
    ASSERT_EQ(scene.meshes[0]->tangents.size(), 4U);
    for (const glm::vec4& tangent : scene.meshes[0]->tangents) {
        // The u of the image now grows along the old bitangent, and its v upwards along -w *
        // cross(n, y).
        EXPECT_NEAR(tangent.x, 0.0F, 1e-6F);
        EXPECT_NEAR(tangent.y, 1.0F, 1e-6F);
        EXPECT_EQ(tangent.w, -1.0F);
    }
}

TEST(LoadScene, GivesGltfsMaterialsAsTheirAuthorsMeant) {
    const test::TemporaryDirectory folder;
    write_text(folder / "lit.gltf", lit_triangle());
    Report report;
    const Scene scene = load_scene(folder / "lit.gltf", report);
    const Material& glass = scene.materials.at(0);
    ASSERT_TRUE(glass.metallic_roughness);
    EXPECT_EQ(glass.metallic_roughness->base_color, glm::vec3(0.5F, 0.25F, 1.0F));
    EXPECT_EQ(glass.metallic_roughness->metallic, 0.0F);
    EXPECT_EQ(glass.metallic_roughness->roughness, 0.5F);
    EXPECT_TRUE(glass.metallic_roughness->texture && glass.diffuse_texture && glass.normal_map);
    EXPECT_EQ(glass.alpha_mode, AlphaMode::blend);
    EXPECT_EQ(glass.opacity, 0.75F);
    EXPECT_TRUE(glass.double_sided);
    EXPECT_EQ(glass.occlusion_strength, 0.25F);
    // The coordinates of the set that the base color uses, after its transform: (x, y) to (2 x +
    // 0.5, 3 y).
    EXPECT_EQ(scene.meshes[0]->texcoords,
              (std::vector<glm::vec2>{{0.5F, 0.0F}, {0.5F, 3.0F}, {0.5F, 0.0F}}));
    // The Phong parameters of the factors remain available.
    EXPECT_NEAR(glass.shininess, 30.0F, 1e-4F);
    EXPECT_NEAR(glass.diffuse.x, 0.5F, 1e-6F);
}

std::size_t unreadable_textures_in(const Report& report) {
    std::size_t count = 0;
    for (const Finding& finding : report.findings())
        count += finding.kind.starts_with("unreadable ") ? 1 : 0;
    return count;
}

TEST(LoadScene, TranslatesGltfsMaterialsToPhongByChoice) {
    const test::TemporaryDirectory folder;
    write_text(folder / "lit.gltf", lit_triangle());
    Report report;
    const Scene scene =
        load_scene(folder / "lit.gltf", {.model = SceneOptions::MaterialModel::phong}, report);
    const Material& glass = scene.materials.at(0);
    EXPECT_FALSE(glass.metallic_roughness);
    EXPECT_EQ(glass.diffuse, glm::vec3(0.5F, 0.25F, 1.0F));
    EXPECT_EQ(glass.alpha_mode, AlphaMode::blend);
    EXPECT_TRUE(glass.diffuse_texture);
    // The image is missing. Only the means for Phong need it.
    EXPECT_EQ(unreadable_textures_in(report), 1U);
}

TEST(LoadScene, CountsUnsupportedContent) {
    const test::TemporaryDirectory folder;
    write_text(folder / "lit.gltf", lit_triangle());
    Report report;
    const Scene scene = load_scene(folder / "lit.gltf", report);
    const Material& material = scene.materials.at(0);
    EXPECT_TRUE(material.double_sided);
    ASSERT_TRUE(material.occlusion_texture && material.emission_texture);
    EXPECT_TRUE(material.occlusion_texture->second_texcoords) << "another set than the base color";
    EXPECT_FALSE(material.emission_texture->second_texcoords);
    ASSERT_TRUE(material.normal_map);
    EXPECT_EQ(material.normal_map->scale, 0.5F);
    EXPECT_EQ(material.normal_map->green, Green::up);
    EXPECT_EQ(report.count("texture transform of its own"), 1U) << "emission, the third source";
    EXPECT_EQ(report.count("missing image 'missing.png', emissiveTexture, normalTexture, "
                           "occlusionTexture, baseColorTexture, metallicRoughnessTexture of "
                           "material 'glass'"),
              1U);
    EXPECT_EQ(report.findings().size(), 2U);
}

TEST(LoadScene, ReadsMeansOfTexturesAndToleratesMissingOnes) {
    RELIEF_NEEDS_SHARED(bottle, "data/models/gltf/WaterBottle/glTF/WaterBottle.gltf");
    RELIEF_NEEDS_SHARED(corset, "data/models/gltf/Corset");
    Report report;
    const SceneOptions phong{.model = SceneOptions::MaterialModel::phong};
    const Scene scene = load_scene(bottle, phong, report);
    EXPECT_TRUE(report.empty());
    const Material& material = scene.materials.at(0);
    EXPECT_GT(material.shininess, 0.5F);   // The factor 1 alone would give 0.
    EXPECT_LT(material.diffuse.x, 0.99F);  // The surface is partly metallic.
    EXPECT_TRUE(material.normal_map && material.diffuse_texture && material.emission_texture);

    std::filesystem::path file;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(corset)) {
        if (entry.path().extension() == ".gltf") file = entry.path();
    }
    ASSERT_FALSE(file.empty());
    EXPECT_NO_THROW((void)load_scene(file, report));
    EXPECT_EQ(unreadable_textures_in(report), 0U);  // With the authored materials, no image is
                                                    // read.
    EXPECT_NO_THROW((void)load_scene(file, phong, report));
    EXPECT_GT(unreadable_textures_in(report), 0U);
}

TEST(LoadScene, ErrorsNameTheFile) {
    Report report;
    for (const char* file : {"/nowhere/model.obj", "/nowhere/model.glb", "/nowhere/model.xyz"}) {
        try {
            (void)load_scene(file, report);
            FAIL() << file;
        } catch (const FileError& error) {
            EXPECT_THAT(error.what(), HasSubstr(file));
        }
    }
}

std::string error_of(const std::filesystem::path& folder) {
    try {
        (void)cube_faces_in(folder);
    } catch (const FileError& error) {
        return error.what();
    }
    return "no error";
}

TEST(CubeFaces, AreFoundInAFolderByTheEndsOfTheirNames) {
    const test::TemporaryDirectory folder;
    const std::vector<std::string> ends = {"posx", "negx", "posy", "negy", "posz", "negz"};
    for (const std::string& end : ends)
        std::ofstream(folder / ("xmas_" + end + ".png")) << "";
    std::ofstream(folder / "readme.txt") << "";
    const CubeFaces faces = cube_faces_in(folder.path());
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(std::get<std::filesystem::path>(faces.faces[i].source),
                  folder / ("xmas_" + ends[i] + ".png"));
    }
    std::ofstream(folder / "other_negy.jpg") << "";
    EXPECT_THAT(error_of(folder.path()),
                HasSubstr("both other_negy.jpg and xmas_negy.png end in negy"));
    std::filesystem::remove(folder / "other_negy.jpg");
    std::filesystem::remove(folder / "xmas_posz.png");
    EXPECT_THAT(error_of(folder.path()), HasSubstr("no file whose name ends in posz"));
    EXPECT_THAT(error_of(folder / "nowhere"), HasSubstr("cannot be read as a folder"));
}

Image small_picture() {
    Image image = make_image(2, 1, 3, 8, ColorSpace::srgb);
    image.samples = std::vector<std::uint8_t>{1, 2, 3, 250, 251, 252};
    return image;
}

TEST(ImageSource, GivesTheSameFromFileBytesAndMemory) {
    const test::TemporaryDirectory folder;
    const std::filesystem::path file = folder / "picture.png";
    write_image(file, small_picture());
    std::ifstream stream(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    const auto* begin = reinterpret_cast<const std::byte*>(text.data());
    const std::vector<std::byte> bytes(begin, begin + text.size());
    for (const ImageSource& source :
         {ImageSource{"file", file}, {"bytes", bytes}, {"memory", small_picture()}}) {
        SCOPED_TRACE(source.name);
        const Image color = decode(source, ImageUse::color);
        EXPECT_EQ(color.samples, small_picture().samples);
        EXPECT_EQ(color.color_space, ColorSpace::srgb);
        const Image data = decode(source, ImageUse::data);
        EXPECT_EQ(data.samples, small_picture().samples);
        EXPECT_EQ(data.color_space, ColorSpace::data);
    }
}

TEST(ImageSource, ThatIsMissingOrBrokenThrows) {
    EXPECT_THROW((void)decode({"a", std::filesystem::path("/nowhere.png")}, ImageUse::color),
                 FileError);
    EXPECT_THROW((void)decode({"b", std::vector<std::byte>(7)}, ImageUse::color), FileError);
}

TEST(MeanColor, OfDataIsTheMeanOfSamples) {
    Image image = make_image(2, 1, 3, 8, ColorSpace::data);
    image.samples = std::vector<std::uint8_t>{0, 255, 51, 255, 255, 102};
    const glm::vec3 mean = mean_color(image);
    EXPECT_FLOAT_EQ(mean.x, 0.5F);
    EXPECT_FLOAT_EQ(mean.y, 1.0F);
    EXPECT_FLOAT_EQ(mean.z, 0.3F);
}

TEST(MeanColor, OfColorsIsTheMeanInLinearLight) {
    Image image = make_image(2, 1, 3, 16, ColorSpace::srgb);
    image.samples = std::vector<std::uint16_t>{0, 0, 0, 65535, 65535, 65535};
    EXPECT_FLOAT_EQ(mean_color(image).x, 0.5F);  // Black and white give half of the light.
    image.samples = std::vector<std::uint16_t>(6, 32768);
    EXPECT_NEAR(mean_color(image).x, linear_from_srgb(32768.0F / 65535), 1e-6F);
}

TEST(MeanColor, OfGrayIsGray) {
    Image image = make_image(1, 2, 2, 8, ColorSpace::data);
    image.samples = std::vector<std::uint8_t>{51, 0, 153, 255};
    EXPECT_FLOAT_EQ(mean_color(image).x, 0.4F);
    EXPECT_FLOAT_EQ(mean_color(image).z, 0.4F);
}

TEST(MeanColor, IgnoresNonFiniteTexels) {
    Image image = make_image(2, 1, 3, 32, ColorSpace::linear);
    image.samples = std::vector<float>{std::nanf(""), 2, INFINITY, 0.25F, 4, -INFINITY};
    EXPECT_EQ(mean_color(image), glm::vec3(0.25F, 3, 1));
    EXPECT_EQ(mean_color(Image{}), glm::vec3(1.0F));
}

TEST(Shared, CopiesAreOneValueUntilOneIsEdited) {
    Shared<std::vector<int>> first = std::vector<int>{1, 2, 3};
    Shared<std::vector<int>> second = first;
    EXPECT_EQ(first->data(), second->data());
    const auto identity = first.identity();
    EXPECT_TRUE(identity.is(second));
    second.edit()[0] = 7;
    EXPECT_EQ(first->at(0), 1);
    EXPECT_EQ(second->at(0), 7);
    EXPECT_TRUE(identity.is(first));
    EXPECT_FALSE(identity.is(second));
}

TEST(Shared, UniqueValueIsEditedInPlace) {
    Shared<std::vector<int>> alone = std::vector<int>{1, 2, 3};
    const auto identity = alone.identity();
    const int* before = alone->data();
    alone.edit()[2] = 5;
    EXPECT_EQ(alone->data(), before);
    EXPECT_FALSE(identity.is(alone));
    EXPECT_EQ(*alone, (std::vector<int>{1, 2, 5}));
}

TEST(Shared, AnIdentityIsNotTakenForThatOfALaterValue) {
    auto first = std::make_unique<Shared<int>>(1);
    const auto identity = first->identity();
    first.reset();
    for (int i = 0; i < 100; ++i)
        EXPECT_FALSE(identity.is(Shared<int>(1)));
}

TEST(Shared, ACopiedSceneHasItsMeshesInCommon) {
    Scene scene;
    scene.meshes.push_back(test::grid(4));
    Scene copy = scene;
    EXPECT_EQ(copy.meshes[0]->positions.data(), scene.meshes[0]->positions.data());
    copy.meshes[0].edit().positions[0].x = 9.0F;
    EXPECT_NE(scene.meshes[0]->positions[0].x, 9.0F);
}

}  // namespace
}  // namespace relief
