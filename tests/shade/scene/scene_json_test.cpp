// SPDX-License-Identifier: Apache-2.0
// Scene files: the documented example, every kind of member, and what is refused with which words.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <tuple>

#include "relief/mesh/image_file.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene_fields.h"
#include "relief/shade/scene_file.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::shade;

namespace {

using ::testing::HasSubstr;

constexpr float json_rounding = 1e-6F;

class SceneFile : public testing::Test {
  protected:
    SceneFile() {
        Image gray = make_image(2, 2, 1, 8, ColorSpace::data);
        for (const char* name : {"a.png", "b.png", "posx.png", "negx.png", "posy.png", "negy.png",
                                 "posz.png", "negz.png"})
            write_image(folder_ / name, gray);
        write_mesh(folder_ / "cube.ply", {test::cube(), {}});
        std::ofstream(folder_ / "two.mtl") << "newmtl one\nKd 1 0 0\nmap_Kd a.png\n";
        std::ofstream(folder_ / "two.obj")
            << "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl one\nf 1/1 2/1 3/1\n";
    }

    SceneGraph load(const std::string& members) {
        const std::filesystem::path file = folder_ / "scene.json";
        std::ofstream(file) << "{\"relief_scene\": 1, " << members << "}";
        return load_scene_graph(file, {}, report_);
    }

    /// Returns the message of loading without the name of the file.
    std::string error_of(const std::string& members) {
        try {
            (void)load(members);
        } catch (const FileError& error) {
            const std::string text = error.what();
            const std::string file = (folder_ / "scene.json").string() + ": ";
            EXPECT_TRUE(text.starts_with(file)) << text;
            return text.substr(std::min(text.size(), file.size()));
        }
        return "no error";
    }

    test::TemporaryDirectory folder_;
    Report report_;
};

TEST(SampleScenes, AreReadWithoutAFindingAndMoveSoundly) {
    std::size_t count = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(test::source_directory() / "data/scenes")) {
        if (entry.path().extension() != ".json") continue;
        SCOPED_TRACE(entry.path());
        ++count;
        Report report;
        SceneGraph graph = load_scene_graph(entry.path(), {}, report);
        EXPECT_TRUE(report.empty());
        EXPECT_TRUE(graph.picture_size && graph.scene.camera);
        pose(graph, 1.25);
        EXPECT_NO_THROW(validate(graph));
    }
    EXPECT_EQ(count, 12U);
}

TEST(SampleScenes, TheModelOfEnvironmentMappingScattersAmbientLight) {
    const Scene scene =
        load_scene(test::source_directory() / "data/scenes/environment-mapping.json");
    EXPECT_GT(scene.ambient.r * scene.materials.at(0).ambient.r, 0.0F);
}

/// Returns the first JSON block of the page that describes the format.
std::string documented_example() {
    std::ifstream stream(test::source_directory() / "docs/scene-files.md");
    const std::string page{std::istreambuf_iterator<char>(stream), {}};
    const std::size_t begin = page.find("```json\n") + 8;
    return page.substr(begin, page.find("```", begin) - begin);
}

TEST_F(SceneFile, AsDocumentedIsRead) {
    std::ofstream(folder_ / "scene.json") << documented_example();
    std::filesystem::copy(test::source_directory() / "data/vase.obj", folder_.path());
    SceneGraph graph = load_scene_graph(folder_ / "scene.json", {}, report_);
    const Scene& scene = graph.scene;
    EXPECT_EQ(scene.instances.size(), 5U);  // Pot, floor, ring and two markers.
    EXPECT_EQ(scene.point_lights.size(), 2U);
    EXPECT_EQ(graph.picture_size, glm::ivec2(640, 480));
    ASSERT_TRUE(scene.camera);
    EXPECT_NEAR(scene.camera->vertical_fov, 0.610865F, json_rounding);
    EXPECT_EQ(scene.ambient, glm::vec3(0.05F));
    EXPECT_NEAR(duration(graph), 8.0, 1e-5);  // The rotation of the ring.
    const glm::vec3 red = scene.point_lights[1].position_world;
    EXPECT_NEAR(red.z, -1.5F, json_rounding);
    pose(graph, 0.9);  // 90 degrees backwards.
    EXPECT_NEAR(graph.scene.point_lights[1].position_world.x, 1.5F, 1e-5F);
}

TEST_F(SceneFile, MaterialsHaveEveryMemberByItsName) {
    const SceneGraph graph = load(R"("materials": {"m": {
        "interpolation": "flat", "ambient": 0.1, "diffuse": [0.2, 0.3, 0.4], "specular": "#ffffff",
        "emission": 2, "shininess": 7, "specular_model": "blinn_phong_normalized",
        "metallic_roughness": {"base_color": 0.5, "metallic": 0.25, "roughness": 0.75, "texture": "a.png",
            "refractive_index": 1.75, "specular": 0.125, "specular_color": [1, 2, 3],
            "clearcoat": 0.5, "clearcoat_roughness": 0.25, "sheen_color": [0, 0.5, 1], "sheen_roughness": 0.75,
            "anisotropy": 0.5, "anisotropy_rotation": -180,
            "specular_texture": "a.png", "specular_color_texture": "b.png", "clearcoat_texture": "a.png",
            "clearcoat_roughness_texture": "b.png", "clearcoat_normal_map": {"texture": "a.png", "scale": 0.5},
            "sheen_color_texture": "b.png", "sheen_roughness_texture": "a.png", "anisotropy_texture": "a.png", "iridescence_texture": "b.png",
            "iridescence_thickness_texture": "a.png", "iridescence_thickness_minimum": 50,
            "iridescence": 0.25, "iridescence_index": 1.75, "iridescence_thickness": 550,
            "transmission": 0.875, "transmission_texture": "a.png", "thickness": 2, "thickness_texture": "b.png",
            "attenuation_distance": 3, "attenuation_color": [0.5, 1, 0]},
        "reflectivity": 0.3, "grazing_reflectivity": 0.9, "fresnel": "conductor", "refractive_index": 1.33,
        "conductor_index": 0.4, "conductor_absorption": 5, "reflection_roughness": 0.6,
        "diffuse_texture": "a.png", "specular_texture": "b.png", "emission_texture": {"image": "a.png",
        "wrap_u": "clamp", "wrap_v": "mirror", "filter": "nearest"}, "occlusion_texture": "b.png",
        "occlusion_strength": 0.5, "opacity_texture": "b.png",
        "normal_map": {"texture": "a.png", "scale": 2, "green": "down", "zero_code": "127.5", "space": "object"},
        "tangent_frame": "derivatives", "specular_antialiasing": true, "alpha_mode": "mask",
        "opacity": 0.7, "alpha_cutoff": 0.2, "double_sided": true, "unlit": true},
        "bumpy": {"like": "gold", "bump_map": {"texture": "b.png", "strength": 3}, "transmission": 0.5}})");
    const Material& m = graph.scene.materials[1];
    EXPECT_EQ(m.name, "m");
    EXPECT_EQ(m.interpolation, Interpolation::flat);
    EXPECT_EQ(m.ambient, glm::vec3(0.1F));
    EXPECT_EQ(m.diffuse, glm::vec3(0.2F, 0.3F, 0.4F));
    EXPECT_EQ(m.specular, glm::vec3(1.0F));
    EXPECT_EQ(m.emission, glm::vec3(2.0F));
    EXPECT_EQ(m.shininess, 7.0F);
    EXPECT_EQ(m.specular_model, SpecularModel::blinn_phong_normalized);
    ASSERT_TRUE(m.metallic_roughness);
    EXPECT_EQ(m.metallic_roughness->base_color, glm::vec3(0.5F));
    EXPECT_EQ(m.metallic_roughness->metallic, 0.25F);
    EXPECT_EQ(m.metallic_roughness->roughness, 0.75F);
    EXPECT_EQ(m.metallic_roughness->refractive_index, 1.75F);
    EXPECT_EQ(m.metallic_roughness->specular, 0.125F);
    EXPECT_EQ(m.metallic_roughness->specular_color, glm::vec3(1, 2, 3));
    EXPECT_EQ(m.metallic_roughness->clearcoat, 0.5F);
    EXPECT_EQ(m.metallic_roughness->clearcoat_roughness, 0.25F);
    EXPECT_EQ(m.metallic_roughness->sheen_color, glm::vec3(0, 0.5F, 1));
    EXPECT_EQ(m.metallic_roughness->sheen_roughness, 0.75F);
    EXPECT_EQ(m.metallic_roughness->anisotropy, 0.5F);
    EXPECT_FLOAT_EQ(m.metallic_roughness->anisotropy_rotation, -std::numbers::pi_v<float>);
    EXPECT_EQ(m.metallic_roughness->iridescence, 0.25F);
    EXPECT_EQ(m.metallic_roughness->iridescence_index, 1.75F);
    EXPECT_EQ(m.metallic_roughness->iridescence_thickness, 550.0F);
    EXPECT_EQ(m.metallic_roughness->iridescence_thickness_minimum, 50.0F);
    EXPECT_EQ(m.metallic_roughness->clearcoat_normal_map->scale, 0.5F);
    EXPECT_EQ(m.metallic_roughness->transmission, 0.875F);
    EXPECT_EQ(m.metallic_roughness->thickness, 2.0F);
    EXPECT_EQ(m.metallic_roughness->attenuation_distance, 3.0F);
    EXPECT_EQ(m.metallic_roughness->attenuation_color, glm::vec3(0.5F, 1, 0));
    for (const auto& texture :
         {m.metallic_roughness->specular_texture, m.metallic_roughness->clearcoat_texture,
          m.metallic_roughness->anisotropy_texture,
          m.metallic_roughness->iridescence_thickness_texture,
          m.metallic_roughness->transmission_texture,
          m.metallic_roughness->sheen_roughness_texture})
        EXPECT_EQ(texture->image, m.metallic_roughness->texture->image);
    for (const auto& texture :
         {m.metallic_roughness->specular_color_texture,
          m.metallic_roughness->clearcoat_roughness_texture,
          m.metallic_roughness->sheen_color_texture, m.metallic_roughness->iridescence_texture,
          m.metallic_roughness->thickness_texture})
        EXPECT_EQ(texture->image, m.specular_texture->image);
    EXPECT_EQ(m.metallic_roughness->texture->image, m.diffuse_texture->image);
    EXPECT_EQ(m.reflectivity, glm::vec3(0.3F));
    EXPECT_EQ(m.grazing_reflectivity, glm::vec3(0.9F));
    EXPECT_EQ(m.fresnel, FresnelModel::conductor);
    EXPECT_EQ(m.refractive_index, 1.33F);
    EXPECT_EQ(m.conductor_index, glm::vec3(0.4F));
    EXPECT_EQ(m.conductor_absorption, glm::vec3(5.0F));
    EXPECT_EQ(m.reflection_roughness, 0.6F);
    EXPECT_EQ(graph.scene.images.size(), 2U);  // Each file occurs once.
    EXPECT_EQ(m.emission_texture->wrap_u, Wrap::clamp);
    EXPECT_EQ(m.emission_texture->wrap_v, Wrap::mirror);
    EXPECT_EQ(m.emission_texture->filter, TextureFilter::nearest);
    EXPECT_TRUE(m.specular_texture && m.occlusion_texture && m.opacity_texture);
    EXPECT_EQ(m.occlusion_strength, 0.5F);
    ASSERT_TRUE(m.normal_map);
    EXPECT_EQ(m.normal_map->scale, 2.0F);
    EXPECT_EQ(m.normal_map->green, Green::down);
    EXPECT_EQ(m.normal_map->flat, FlatCode::half);
    EXPECT_EQ(m.normal_map->space, NormalSpace::object);
    EXPECT_EQ(m.tangent_frame, TangentFrame::derivatives);
    EXPECT_EQ(m.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(m.opacity, 0.7F);
    EXPECT_EQ(m.alpha_cutoff, 0.2F);
    EXPECT_TRUE(m.specular_antialiasing && m.double_sided && m.unlit);
    const Material& bumpy = graph.scene.materials[0];
    EXPECT_EQ(bumpy.name, "bumpy");
    EXPECT_EQ(bumpy.diffuse, material_by_name("gold")->diffuse);
    EXPECT_EQ(bumpy.bump_map->strength, 3.0F);
    EXPECT_EQ(bumpy.transmission, 0.5F);
}

TEST_F(SceneFile, ImagesAreNumberedInTheOrderOfTheKeys) {
    // Saved scenes refer to the images of their source by number.
    const SceneGraph graph = load(R"("materials": {"m": {"specular_texture": "posx.png",
        "normal_map": "b.png", "diffuse_texture": "a.png"}})");
    const Material& m = graph.scene.materials[0];
    EXPECT_EQ(m.diffuse_texture->image, 0U);
    EXPECT_EQ(m.normal_map->texture.image, 1U);
    EXPECT_EQ(m.specular_texture->image, 2U);
}

TEST_F(SceneFile, NormalMapsFollowTheMetadataOfTheirFiles) {
    write_image(folder_ / "down.png", make_image(2, 2, 3, 8, ColorSpace::data),
                write_description({.kind = MapKind::object_normal, .green = Green::down}, 8));
    const SceneGraph graph = load(R"("materials": {
        "a": {"normal_map": "down.png"},
        "b": {"normal_map": {"texture": "down.png", "scale": 2}},
        "c": {"normal_map": {"texture": "down.png", "green": "up"}},
        "d": {"normal_map": {"texture": "down.png", "green": "up", "space": "object"}}})");
    for (const Material& material : graph.scene.materials) {
        const bool is_stated = material.name < "c";
        EXPECT_EQ(material.normal_map->green, is_stated ? Green::down : Green::up);
        EXPECT_EQ(material.normal_map->space, NormalSpace::object);
    }
    EXPECT_TRUE(report_.empty());
}

TEST_F(SceneFile, MapsThatStateAnotherKindAreReported) {
    const auto write_as = [&](const char* name, MapKind kind) {
        write_image(folder_ / name, make_image(2, 2, 3, 8, ColorSpace::data),
                    write_description({.kind = kind}, 8));
    };
    write_as("height.png", MapKind::height);
    write_as("normal.png", MapKind::normal);
    write_as("color.png", MapKind::color);
    std::ofstream(folder_ / "wrong.mtl") << "newmtl one\nmap_Bump normal.png\nmap_Ke color.png\n";
    std::ofstream(folder_ / "wrong.obj") << "mtllib wrong.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                                            "vt 0 0\nusemtl one\nf 1/1 2/1 3/1\n";
    (void)load(R"("nodes": [{"model": "wrong.obj"}, {"shape": "quad", "material": "b"}],
        "materials": {
            "a": {"normal_map": "height.png", "occlusion_texture": "normal.png"},
            "b": {"diffuse_texture": "normal.png", "bump_map": "height.png"},
            "c": {"normal_map": {"texture": "normal.png", "space": "object"}}})");
    const auto expect = [&](const std::string& kind, std::size_t material,
                            const std::string& outcome) {
        const auto found = std::ranges::find(report_.findings(), kind, &Finding::kind);
        ASSERT_NE(found, report_.findings().end()) << kind;
        EXPECT_EQ(found->first, std::vector{material}) << kind;
        EXPECT_EQ(found->outcome, outcome);
    };
    EXPECT_EQ(report_.findings().size(), 4U);
    expect("bump map that is a normal map in tangent space, as its metadata say", 0,
           "is drawn as a height map");
    expect("normal map that is a height map, as its metadata say", 0,
           "is drawn as a normal map in tangent space");
    expect("diffuse texture that is a normal map in tangent space, as its metadata say", 1,
           "is drawn as a color map");
    expect("normal map that is a normal map in tangent space, as its metadata say", 2,
           "is drawn as a normal map in object space");
}

TEST_F(SceneFile, LightsHaveThreeColors) {
    const SceneGraph graph = load(R"("ambient": 0.1, "lights": [
        {"type": "point", "position": [1, 2, 3], "ambient": 0.2, "diffuse": [1, 0, 0], "specular": 1,
         "intensity": 2, "falloff": "none"},
        {"type": "directional", "direction": [0, -2, 0], "color": "#00ff00"},
        {"type": "spot", "position": [0, 5, 0], "direction": [0, -1, 0], "inner_cone": 10, "outer_cone": 20,
         "range": 9}])");
    const Scene& scene = graph.scene;
    EXPECT_EQ(scene.ambient, glm::vec3(0.1F));
    EXPECT_EQ(scene.point_lights[0].ambient, glm::vec3(0.4F));  // 2 times 0.2.
    EXPECT_NEAR(ambient_light(scene).x, 0.5F, json_rounding);
    EXPECT_EQ(scene.point_lights[0].intensity, glm::vec3(2, 0, 0));
    EXPECT_EQ(scene.point_lights[0].highlight_intensity, glm::vec3(2.0F));
    EXPECT_EQ(scene.point_lights[0].falloff, Falloff::none);
    EXPECT_EQ(scene.point_lights[0].position_world, glm::vec3(1, 2, 3));
    EXPECT_EQ(scene.directional_lights[0].irradiance, glm::vec3(0, 1, 0));
    EXPECT_FALSE(scene.directional_lights[0].highlight_irradiance);
    EXPECT_NEAR(scene.spot_lights[0].outer_cone, std::numbers::pi_v<float> / 9, json_rounding);
    EXPECT_EQ(scene.spot_lights[0].point.range, 9.0F);
}

TEST_F(SceneFile, LightsKeepTheirAmbientLightAndTheirSwitch) {
    SceneGraph graph = load(R"("ambient": 0.1, "nodes": [{"shape": "quad"}], "lights": [
        {"type": "point", "ambient": [0.2, 0, 0], "intensity": 2},
        {"type": "directional", "direction": [0, -1, 0], "ambient": 0.25, "on": false},
        {"type": "spot", "direction": [0, -1, 0], "ambient": 0.5}])");
    Scene& scene = graph.scene;
    EXPECT_FALSE(scene.directional_lights[0].on);
    EXPECT_TRUE(scene.point_lights[0].on);
    EXPECT_EQ(ambient_light(scene), scene.ambient + glm::vec3(0.4F, 0, 0) + glm::vec3(0.5F));
    scene.spot_lights[0].point.on = false;
    EXPECT_EQ(ambient_light(scene), scene.ambient + glm::vec3(0.4F, 0, 0));

    // A saved scene has the same lights.
    save_scene(folder_ / "saved.json", {folder_ / "scene.json", scene, Camera{}, {8, 8}, {}});
    const Scene saved = load_scene_graph(folder_ / "saved.json", {}, report_).scene;
    EXPECT_EQ(saved.ambient, scene.ambient);
    EXPECT_EQ(saved.point_lights[0].ambient, scene.point_lights[0].ambient);
    EXPECT_EQ(saved.directional_lights[0].ambient, glm::vec3(0.25F));
    EXPECT_FALSE(saved.directional_lights[0].on);
    EXPECT_FALSE(saved.spot_lights.at(0).point.on);
    EXPECT_EQ(ambient_light(saved), ambient_light(scene));
    EXPECT_THROW(load(R"("lights": [{"type": "point", "ambient": -1}])"), FileError);
}

TEST_F(SceneFile, OnlyLightsReplaceTheAmbientLightOfOthers) {
    // As scenes were saved whose lights had no ambient light of their own.
    const Scene scene = load(R"("ambient": 0.75, "lights": [{"type": "point", "ambient": 0.5}],
        "only_lights": [{"type": "point"}])")
                            .scene;
    EXPECT_EQ(ambient_light(scene), glm::vec3(0.75F));
}

TEST_F(SceneFile, ShadowsHaveASizeInDegrees) {
    EXPECT_FALSE(load(R"("ambient": 0)").scene.shadow);
    EXPECT_FALSE(load(R"("shadow": null)").scene.shadow);
    EXPECT_EQ(load(R"("shadow": {})").scene.shadow->size, Shadow{}.size);
    EXPECT_FLOAT_EQ(load(R"("shadow": {"size": 18})").scene.shadow->size,
                    0.1F * std::numbers::pi_v<float>);
    EXPECT_THROW(load(R"("shadow": {"size": 31})"), FileError);
    EXPECT_THROW(load(R"("shadow": {"sizes": 1})"), FileError);
}

TEST_F(SceneFile, AmbientOcclusionHasADistance) {
    EXPECT_FALSE(load(R"("ambient_occlusion": null)").scene.ambient_occlusion);
    EXPECT_EQ(load(R"("ambient_occlusion": {})").scene.ambient_occlusion->distance, 0.5F);
    EXPECT_EQ(load(R"("ambient_occlusion": {"distance": 0.25})").scene.ambient_occlusion->distance,
              0.25F);
    EXPECT_THROW(load(R"("ambient_occlusion": {"distance": -1})"), FileError);
}

TEST_F(SceneFile, NodesCarryModelsShapesLightsAndCameras) {
    const SceneGraph graph = load(R"("nodes": [{"translation": [10, 0, 0], "scale": 2, "children": [
        {"translation": [1, 0, 0], "model": "cube.ply", "material": "emerald"},
        {"model": "two.obj", "material_changes": {"reflectivity": 0.5}},
        {"model": "two.obj", "material_changes": {"diffuse_texture": null, "metallic_roughness": null}},
        {"shape": "sphere", "material": {"diffuse": 0.3, "name": "own"}},
        {"rotation": {"axis": [0, 1, 0], "angle": 90}, "light": {"type": "directional"}},
        {"light": {"type": "point", "position": [0, 1, 0]}},
        {"rotation": [0, 0, 0, 1], "translation": [0, 0, 4], "camera": {"fov": 60, "near": 0.5}}]}])");
    const Scene& scene = graph.scene;
    ASSERT_EQ(scene.instances.size(), 4U);
    EXPECT_EQ(scene.instances[0].world_from_object[3], glm::vec4(12, 0, 0, 1));
    EXPECT_EQ(scene.instances[0].world_from_object[0].x, 2.0F);
    const auto material = [&](std::size_t mesh) {
        return scene.materials.at(scene.meshes[mesh]->material_ranges.at(0).material.value());
    };
    EXPECT_EQ(material(0).name, "emerald");
    EXPECT_EQ(material(1).name, "one");
    EXPECT_EQ(material(1).diffuse, glm::vec3(1, 0, 0));
    EXPECT_EQ(material(1).reflectivity, glm::vec3(0.5F));
    EXPECT_EQ(scene.images.at(material(1).diffuse_texture->image).name,
              (folder_ / "a.png").string());
    EXPECT_EQ(material(2).name, "one");
    EXPECT_FALSE(material(2).diffuse_texture);
    EXPECT_EQ(material(3).name, "own");
    EXPECT_NEAR(scene.directional_lights[0].direction_world.x, -1.0F, json_rounding);
    EXPECT_EQ(scene.point_lights[0].position_world, glm::vec3(10, 2, 0));
    ASSERT_TRUE(scene.camera);
    EXPECT_EQ(scene.camera->world_from_view[3], glm::vec4(10, 0, 8, 1));
    EXPECT_NEAR(scene.camera->vertical_fov, std::numbers::pi_v<float> / 3, json_rounding);
    EXPECT_GT(scene.camera->far, 8.0F);
}

TEST_F(SceneFile, EnvironmentsComeInFiveLayoutsOrAreTheStudio) {
    const SceneGraph faces = load(R"("environment": {"faces": ["posx.png", "negx.png", "posy.png",
        "negy.png", "posz.png", "negz.png"], "left_handed": true, "intensity": 2, "skybox": false,
        "lights": true, "rotation": 90, "skybox_blur": 0.25})");
    const Environment& environment = faces.scene.environment.value();
    EXPECT_TRUE(std::get<CubeFaces>(environment.source).left_handed);
    EXPECT_EQ(environment.intensity, 2.0F);
    EXPECT_EQ(environment.skybox_blur, 0.25F);
    EXPECT_TRUE(environment.lights && !environment.skybox);
    EXPECT_FLOAT_EQ(environment.rotation, 0.5F * std::numbers::pi_v<float>);
    const auto source = [&](const std::string& text) {
        return load("\"environment\": " + text).scene.environment->source;
    };
    EXPECT_EQ(std::get<CubeFaces>(source(R"({"folder": "."})")).faces[3].name,
              (folder_ / "negy.png").string());
    EXPECT_NO_THROW((void)std::get<CubeCross>(source(R"({"cross": "a.png"})")));
    EXPECT_NO_THROW((void)std::get<Equirectangular>(source(R"({"panorama": "a.png"})")));
    EXPECT_NO_THROW((void)std::get<AngularMap>(source(R"({"angular_map": "a.png"})")));
    const Environment studio =
        load(R"("environment": {"studio": true, "intensity": 3})").scene.environment.value();
    EXPECT_TRUE(is_studio(studio));
    EXPECT_EQ(studio.intensity, 3.0F);
    EXPECT_TRUE(studio.lights && !studio.skybox);
    EXPECT_THROW(load(R"("environment": {"studio": false})"), FileError);
}

TEST_F(SceneFile, CamerasLookAtAPointOrFrameTheScene) {
    const Scene looking =
        load(R"("camera": {"eye": [0, 0, 5], "target": [0, 0, 1], "far": 50})").scene;
    EXPECT_EQ(looking.camera->world_from_view[3], glm::vec4(0, 0, 5, 1));
    EXPECT_EQ(looking.camera->near, 0.04F);
    EXPECT_EQ(looking.camera->far, 50.0F);
    const Scene framed = load(R"("nodes": [{"shape": "cube"}], "light_markers": 0.1,
        "lights": [{"type": "point", "position": [0, 100, 0]}],
        "camera": {"azimuth": 0, "elevation": 0}, "picture": {"width": 200, "height": 100})")
                             .scene;
    // Markers do not move the camera away. The cube of edge 2 fills the height of the picture.
    EXPECT_NEAR(framed.camera->world_from_view[3].z, 1.0F + 1.04F / std::tan(0.30543F), 1e-3F);
    EXPECT_GT(framed.camera->far, 99.0F);
}

// Each form of the camera takes every field that the type has.
TEST_F(SceneFile, CamerasTakeAllFieldsInEachForm) {
    const std::string fields = R"("fov": 50, "near": 0.5, "far": 70, "orthographic_height": 3)";
    const std::vector<std::string> forms = {
        R"("eye": [0, 0, 5])", R"("azimuth": 20)",
        R"("matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1])"};
    const auto expect_fields = [](const Camera& camera, const std::string& form) {
        EXPECT_NEAR(camera.vertical_fov, 50.0F * std::numbers::pi_v<float> / 180.0F, json_rounding)
            << form;
        EXPECT_EQ(camera.near, 0.5F) << form;
        EXPECT_EQ(camera.far, 70.0F) << form;
        EXPECT_EQ(camera.orthographic_height, 3.0F) << form;
    };
    static_assert(std::tuple_size_v<decltype(fields_of<Camera>)> == 4, "test the new field, too");
    for (const std::string& form : forms) {
        const SceneGraph graph =
            load(R"("nodes": [{"shape": "cube"}], "camera": {)" + form + ", " + fields + "}");
        expect_fields(graph.scene.camera.value(), form);
    }
    const SceneGraph graph = load(R"("nodes": [{"camera": {)" + fields + "}}]");
    expect_fields(graph.scene.camera.value(), "node");
}

TEST_F(SceneFile, SettingsOfThePicture) {
    const Scene scene = load(R"("background": [0.1, 0.2, 0.3, 0.4], "exposure": 2,
        "tone_mapping": "aces", "clamp_terms": true)")
                            .scene;
    EXPECT_TRUE(scene.clamp_terms);
    EXPECT_EQ(scene.background, glm::vec4(0.1F, 0.2F, 0.3F, 0.4F));
    EXPECT_EQ(scene.exposure, 2.0F);
    EXPECT_EQ(scene.tone_mapping, ToneMapping::aces);
    EXPECT_EQ(load(R"("background": "#ffffff")").scene.background, glm::vec4(1.0F));
}

TEST_F(SceneFile, NestsNodesTwoHundredDeepAndNoMore) {
    const auto nested = [](int levels) {
        std::string text = "\"nodes\": ";
        for (int i = 1; i < levels; ++i)
            text += "[{\"translation\": [1, 0, 0], \"children\": ";
        text += "[{}]";
        for (int i = 1; i < levels; ++i)
            text += "}]";
        return text;
    };
    EXPECT_EQ(load(nested(200)).nodes.size(), 200U);
    EXPECT_THAT(error_of(nested(201)), HasSubstr("lies more than 200 levels deep"));
    EXPECT_THAT(error_of(nested(20000)), HasSubstr("its JSON is nested deeper than 1024"));
}

TEST_F(SceneFile, RefusesUnknownKeysWithAPointer) {
    const auto expect = [&](const std::string& members, const std::string& error) {
        EXPECT_THAT(error_of(members), HasSubstr(error)) << members;
    };
    expect(R"("light": [])",
           "/: 'light' is not known here; did you mean 'lights' or 'light_markers'? (known: ");
    expect(R"("materials": {"a/b": {"difuse": 1}})",
           "/materials/a~1b: 'difuse' is not known here; did you mean 'diffuse'?");
    expect(R"("materials": {"m": {"like": "gild"}})",
           "/materials/m/like: is 'gild', but must be one of");
    expect(R"("materials": {"m": {"shininess": -1}})",
           "/materials/m/shininess: is -1, but must be within [0, 1000000]");
    expect(R"("materials": {"m": {"diffuse": "red"}})",
           "/materials/m/diffuse: must be three numbers, one number, or \"#rrggbb\"");
    expect(R"("materials": {"m": {"normal_map": "a.png", "bump_map": "b.png"}})",
           "/materials/m: has a normal map and a bump map");
    expect(R"("nodes": [{"shape": "cub"}])",
           "/nodes/0/shape: is 'cub', but must be one of quad, sphere, cube, torus, cylinder; did "
           "you mean 'cube'?");
    expect(R"("nodes": [{"shape": {"sphere": {"slices": 2}}}])",
           "/nodes/0/shape: slices of a sphere are 2, but must be within [3, 4096]");
    expect(R"("nodes": [{"shape": {"sphere": {"slice": 9}}}])",
           "/nodes/0/shape/sphere: 'slice' is not known here; did you mean 'slices'?");
    expect(R"("nodes": [{"shape": "cube", "material": "golde"}])", "did you mean 'gold'?");
    expect(R"("nodes": [{"model": "nowhere.obj"}])", "/nodes/0/model: there is no file ");
    expect(R"("nodes": [{"model": "a.png"}])", "/nodes/0/model: ");
    expect(R"("nodes": [{"model": "scene.json"}])", "/nodes/0/model: is a scene file");
    expect(R"("nodes": [{"material": "gold"}])", "/nodes/0/material: needs a 'model'");
    expect(R"("nodes": [{}, {"light": {"type": "lamp"}}])",
           "/nodes/1/light/type: is 'lamp', but must be one of directional, point, spot");
    expect(R"("nodes": [{"light": {"type": "point", "outer_cone": 3}}])",
           "/nodes/0/light: 'outer_cone' is not known here");
    expect(R"("lights": [{"type": "spot"}])", "/lights/0: has no 'direction'");
    expect(R"("lights": [{"type": "point", "color": 1, "diffuse": 1}])",
           "/lights/0/diffuse: means the same as 'color'");
    expect(R"("nodes": [{"matrix": [1, 2]}])", "/nodes/0/matrix: must be an array of 16 numbers");
    expect(R"("nodes": [{"scale": true}])", "/nodes/0/scale: must be an array of 3 numbers");
    expect(R"("nodes": [{"translation": [1, 2, 1e99]}])",
           "/nodes/0/translation/2: is 1e+99, but must be within");
    expect(R"("nodes": [{"rotation": {"axis": [0, 0, 0], "angle": 3}}])",
           "/nodes/0/rotation/axis: must have a length");
    expect(R"("nodes": [{"camera": {}}], "camera": {})", "/camera: is a second camera");
    expect(R"("camera": {"eye": [1, 2, 3], "azimuth": 3})",
           "/camera/azimuth: sets the camera's transform");
    expect(R"("camera": {"eye": [0, 0, 0]})", "/camera/eye: is at the target");
    expect(R"("environment": {})", "/environment: must have one of 'faces'");
    expect(R"("environment": {"cross": "a.png", "left_handed": true})",
           "/environment/left_handed: applies only to six faces");
    expect(R"("environment": {"folder": "nowhere"})", "cannot be read as a folder");
    expect(R"("picture": {"width": 0, "height": 1})",
           "/picture/width: must be an integer within [1, 16384]");
    expect(R"("ambient": 1, "ambient": 2)", "the key 'ambient' occurs twice in one object");
    expect(R"("ambient": -1)", "ambient light is (-1, -1, -1)");  // The check of the scene itself.
    expect(R"("relief_scene": 2)", "occurs twice");
    std::ofstream(folder_ / "other.json") << "{\"relief_scene\": 2}";
    EXPECT_THROW((void)load_scene_graph(folder_ / "other.json", {}, report_), FileError);
    std::ofstream(folder_ / "other.json") << "{\"relief_scene\": 1";
    EXPECT_THROW((void)load_scene_graph(folder_ / "other.json", {}, report_), FileError);
    std::ofstream(folder_ / "other.json") << "[]";
    EXPECT_THROW((void)load_scene_graph(folder_ / "other.json", {}, report_), FileError);
}

}  // namespace
}  // namespace relief
