// SPDX-License-Identifier: Apache-2.0
// Scenes as composed from a model and options, without drawing them; lights as text.
#include "scene_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/options.h"
#include "environment_options.h"
#include "light_options.h"
#include "material_options.h"
#include "relief/shade/effects.h"
#include "support/invariants.h"
#include "tools/workplace.h"
#include "view_options.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

using test::degrees_between;
using test::Workplace;
using testing::HasSubstr;
using testing::IsEmpty;

ComposedScene composed(ViewOptions options) {
    Stages stages(true);
    Report report;
    return compose_scene(options, stages, report);
}

/// Options that ask for nothing but a model.
ViewOptions of(const std::filesystem::path& model) {
    ViewOptions options;
    options.model = model;
    return options;
}

TEST(SceneOptions, DefaultsChangeNoMaterial) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    const ComposedScene plain = composed(of(workplace / "square.obj"));
    for (const Material& material : plain.scene().materials) {
        EXPECT_EQ(material.diffuse, default_material().diffuse);
        EXPECT_EQ(material.specular, default_material().specular);
        EXPECT_FALSE(material.diffuse_texture || material.normal_map);
    }
    EXPECT_FALSE(plain.scene().environment);
    EXPECT_THAT(plain.scene().images, IsEmpty());
}

TEST(SceneOptions, MeshesWithoutAMaterialTakePartInAllMaterials) {
    const Workplace workplace;
    workplace.write("m.mtl", "newmtl red\nKd 1 0 0\n");
    workplace.write("two.obj",
                    "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl red\nf 1 2 3\n");
    ViewOptions options = of(workplace / "two.obj");
    options.material_fields.set(&Material::shininess, 77.0F);
    const Scene scene = composed(options).scene();
    for (const Mesh& mesh : scene.meshes) {
        for (const MaterialRange& range : mesh.material_ranges) {
            ASSERT_TRUE(range.material);
            EXPECT_EQ(scene.materials.at(*range.material).shininess, 77.0F);
        }
    }
}

TEST(SceneOptions, MapReplacesTheDiffuseColorOfEveryMaterial) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    ViewOptions options = of(workplace / "square.obj");
    options.diffuse_map = "map.png";
    const Scene scene = composed(options).scene();
    ASSERT_EQ(scene.images.size(), 1U);
    EXPECT_EQ(std::get<std::filesystem::path>(scene.images[0].source), "map.png")
        << "named, and read only when it is drawn";
    ASSERT_EQ(scene.materials.size(), 1U);
    EXPECT_EQ(scene.materials[0].diffuse, glm::vec3(1.0F));
    EXPECT_TRUE(scene.materials[0].diffuse_texture);
}

TEST(SceneOptions, AHeightMapDisplacesIfADepthOrAMethodIsGiven) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    ViewOptions options = of(workplace / "square.obj");
    options.height_map = "h.png";
    options.height_as = HeightUse::bump_map;
    options.strength = 12.0;
    EXPECT_FALSE(composed(options).scene().materials.at(0).height_map);
    options.relief_fields.set(&ReliefMap::method, HeightMethod::relief_mapping);
    options.relief_fields.set(&ReliefMap::layers, 40);
    const Scene scene = composed(options).scene();
    const std::optional<ReliefMap>& map = scene.materials.at(0).height_map;
    ASSERT_TRUE(map);
    EXPECT_EQ(map->depth, 12.0F) << "the strength";
    EXPECT_EQ(map->method, HeightMethod::relief_mapping);
    EXPECT_EQ(map->layers, 40);
    EXPECT_FALSE(map->self_shadow || map->write_depth);
    EXPECT_EQ(map->bound, 0.5F);
    EXPECT_EQ(map->silhouette, ReliefSilhouette::none);
    EXPECT_EQ(scene.images.at(map->texture.image).name, "h.png");
    options.relief_fields.set(&ReliefMap::method, HeightMethod::relaxed_cones);
    EXPECT_THROW((void)composed(options), UsageError) << "no cone map";
    options.cone_map = "c.png";
    EXPECT_TRUE(composed(options).scene().materials.at(0).height_map->cones);
}

TEST(SceneOptions, ANamedMaterialReplacesColorTexturesButKeepsHoles) {
    const Workplace workplace;
    workplace.write_square("plain.obj");
    workplace.write("m.mtl",
                    "newmtl wall\nmap_Kd a.png\nmap_Ks b.png\nnorm c.png\n"
                    "newmtl leaf\nmap_Kd a.png\nmap_d d.png\n");
    workplace.write("model.obj", "mtllib m.mtl\nusemtl wall\n" + workplace.read("plain.obj") +
                                     "usemtl leaf\nf 1/1 2/2 3/3\n");
    ViewOptions options = of(workplace / "model.obj");
    options.material = "gold";
    const Scene scene = composed(options).scene();
    const Material& wall = scene.materials.at(0);
    EXPECT_FALSE(wall.diffuse_texture || wall.specular_texture);
    EXPECT_TRUE(wall.normal_map);
    EXPECT_TRUE(scene.materials.at(1).diffuse_texture) << "its alpha may cut holes";
    options.diffuse_map = "e.png";
    EXPECT_TRUE(composed(options).scene().materials.at(0).diffuse_texture) << "asked for";
}

TEST(SceneOptions, NotesMapsThatDoNotShow) {
    const Workplace workplace;
    workplace.write_square("plain.obj");
    workplace.write("m.mtl", "newmtl wall\nnorm c.png\n");
    workplace.write("model.obj", "mtllib m.mtl\nusemtl wall\n" + workplace.read("plain.obj"));
    ViewOptions options = of(workplace / "model.obj");
    options.material_fields.set(&Material::interpolation, Interpolation::gouraud);
    EXPECT_THAT(composed(options).notes,
                testing::Contains(HasSubstr("the normal or bump map of 1 material does not show")));
    options.material_fields.set(&Material::interpolation, Interpolation::per_pixel);
    EXPECT_THAT(composed(options).notes, testing::Not(testing::Contains(HasSubstr("bump map"))));
}

TEST(SceneOptions, TransmissionComesWithTheReflectivityOfGlass) {
    ViewOptions options;
    options.material_fields.set(&Material::transmission, 0.75F);
    options.material_fields.set(&Material::refractive_index, 1.5F);
    Material material;
    options.material_fields.apply(material);
    complete_reflection(material, options);
    EXPECT_EQ(material.transmission, 0.75F);
    EXPECT_EQ(material.refractive_index, 1.5F);
    EXPECT_EQ(material.reflectivity, glm::vec3(0.04F));

    Material mirror;
    mirror.reflectivity = glm::vec3(0.5F);
    options.material_fields.apply(mirror);
    complete_reflection(mirror, options);
    EXPECT_EQ(mirror.transmission, 0.75F);
    EXPECT_EQ(mirror.reflectivity, glm::vec3(0.5F)) << "its own";
}

TEST(SceneOptions, DefaultLightsFollowTheCamera) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    ViewOptions options = of(workplace / "square.obj");
    for (const float azimuth : {0.0F, 1.0F, 3.0F}) {
        options.camera = CameraOption{.azimuth = azimuth, .elevation = 0.3F};
        const ComposedScene lit = composed(options);
        ASSERT_EQ(lit.scene().directional_lights.size(), 2U);
        EXPECT_NE(lit.scene().ambient, glm::vec3(0.0F));
        const glm::vec3 to_viewer = towards(azimuth, 0.3F);
        for (const DirectionalLight& light : lit.scene().directional_lights)
            EXPECT_LT(test::degrees_between(-light.direction_world, to_viewer), 80.0);
    }
}

TEST(SceneOptions, CameraWithAPositionMovesNoLight) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    ViewOptions options = of(workplace / "square.obj");
    const ComposedScene usual = composed(options);
    options.camera = CameraOption{.azimuth = 2.0F, .elevation = -0.3F};
    options.camera->place = CameraPlace{{0.5F, 0.25F, 0.0F}, 3.0F};
    const ComposedScene placed = composed(options);
    ASSERT_EQ(placed.scene().directional_lights.size(), 2U);
    EXPECT_EQ(placed.scene().directional_lights[0].direction_world,
              usual.scene().directional_lights[0].direction_world);
    const glm::vec3 eye = glm::vec3(0.5F, 0.25F, 0.0F) + 3.0F * towards(2.0F, -0.3F);
    EXPECT_NEAR(glm::distance(glm::vec3(placed.camera.world_from_view[3]), eye), 0.0F, 1e-5F);
}

/// A triangle of two materials that a variant exchanges, and two cameras, of which the second is
/// orthographic.
std::filesystem::path model_with_choices(const Workplace& workplace) {
    workplace.write("choices.gltf", R"({"asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_materials_variants"],
        "extensions": {"KHR_materials_variants": {"variants": [{"name": "day"}, {"name": "night"}]}},
        "materials": [{"name": "white"}, {"name": "black", "pbrMetallicRoughness":
            {"baseColorTexture": {"index": 0, "texCoord": 1}}}],
        "images": [{"uri": "wall.png"}], "textures": [{"source": 0}],
        "buffers": [{"byteLength": 36, "uri":
            "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
            "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC2"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_1": 1}, "material": 0, "extensions":
            {"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [1]}]}}}]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}},
            {"name": "plan", "type": "orthographic",
             "orthographic": {"xmag": 2, "ymag": 2, "znear": 0, "zfar": 8}}],
        "scenes": [{"nodes": [0, 1, 2]}],
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 3]},
            {"camera": 1, "translation": [0, 0, 4]}]})");
    return workplace / "choices.gltf";
}

TEST(SceneOptions, AVariantGivesPrimitivesItsMaterials) {
    const Workplace workplace;
    ViewOptions options = of(model_with_choices(workplace));
    const auto material = [&] {
        const Scene scene = composed(options).scene();
        return scene.materials.at(*scene.meshes.at(0)->material_ranges.at(0).material).name;
    };
    EXPECT_EQ(material(), "white");
    options.material_variant = "day";
    EXPECT_EQ(material(), "white") << "this variant does not name the primitive";
    options.material_variant = "night";
    EXPECT_EQ(material(), "black");
    EXPECT_EQ(composed(options).scene().meshes.at(0)->texcoords.size(), 3U)
        << "those of the set of this material's texture";
    options.material_variant = "2";
    EXPECT_EQ(material(), "black");
    options.material_variant = "dusk";
    EXPECT_THROW(composed(options), Error);
}

TEST(SceneOptions, ACameraOfTheFileCanBeChosen) {
    const Workplace workplace;
    ViewOptions options = of(model_with_choices(workplace));
    EXPECT_EQ(composed(options).camera.world_from_view[3].z, 3.0F);
    EXPECT_FALSE(composed(options).camera.orthographic_height);
    options.model_camera = "plan";
    const Camera plan = composed(options).camera;
    EXPECT_EQ(plan.world_from_view[3].z, 4.0F);
    EXPECT_EQ(plan.orthographic_height, 4.0F);
    EXPECT_GT(plan.near, 0.0F) << "glTF allows 0";
    options.model_camera = "camera 1";
    EXPECT_EQ(composed(options).camera.world_from_view[3].z, 3.0F);
    options.model_camera = "3";
    EXPECT_THROW(composed(options), UsageError);
}

TEST(SceneOptions, OrthographicCameraShowsTheModel) {
    const Workplace workplace;
    workplace.write_square("square.obj");  // From (-1,-1,0) to (1,1,0).
    ViewOptions options = of(workplace / "square.obj");
    options.orthographic = true;
    options.size = {200, 100};
    options.camera = CameraOption{};
    EXPECT_NEAR(composed(options).camera.orthographic_height.value(), 2.08F, 1e-5F);
    options.camera->distance_factor = 0.5F;
    EXPECT_NEAR(composed(options).camera.orthographic_height.value(), 1.04F, 1e-5F);
    options.camera->place = CameraPlace{glm::vec3(0.0F), 2.0F};
    options.vertical_fov = glm::radians(90.0F);
    EXPECT_NEAR(composed(options).camera.orthographic_height.value(), 4.0F, 1e-5F);
    // A camera of the file keeps its place.
    options = of(model_with_choices(workplace));
    options.orthographic = true;
    const ComposedScene drawn = composed(options);
    EXPECT_EQ(drawn.camera.world_from_view[3].z, 3.0F);
    EXPECT_NEAR(drawn.camera.orthographic_height.value(), 2.0F * 1.04F, 1e-5F)
        << "the triangle reaches 1 above the axis of the camera";
    EXPECT_EQ(drawn.scene().camera, drawn.camera);
}

/// Writes a triangle with a material of these members of glTF.
void write_triangle(const Workplace& workplace, const std::string& name,
                    const std::string& material) {
    workplace.write(name, R"({"asset": {"version": "2.0"}, "materials": [{"name": "paint", )" +
                              material + R"(}],
        "buffers": [{"byteLength": 36, "uri":
            "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
            "min": [0, 0, 0], "max": [1, 1, 0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
        "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0})");
}

TEST(SceneOptions, StudioLightsReflectiveModels) {
    const Workplace workplace;
    const std::string dielectric = R"("pbrMetallicRoughness": {"metallicFactor": 0})";
    const auto coated = [&](const std::string& extension, const std::string& member) {
        return dielectric + R"(, "extensions": {"KHR_materials_)" + extension + R"(": {")" +
               member + R"(": 0.5}})";
    };
    const std::vector<std::pair<std::string, bool>> materials = {
        {R"("pbrMetallicRoughness": {"metallicFactor": 0.5})", true},
        {coated("clearcoat", "clearcoatFactor"), true},
        {coated("transmission", "transmissionFactor"), true},
        {coated("specular", "specularFactor"), false},
        {dielectric, false},
        {R"("extensions": {"KHR_materials_unlit": {}})", false}};
    for (const auto& [material, is_lit] : materials) {
        SCOPED_TRACE(material);
        write_triangle(workplace, "paint.gltf", material);
        ViewOptions options = of(workplace / "paint.gltf");
        const ComposedScene usual = composed(options);
        EXPECT_EQ(usual.scene().environment && is_studio(*usual.scene().environment), is_lit);
        const auto note = HasSubstr(
            "material 'paint' is metallic, coated or transmissive and "
            "needs an environment");
        if (is_lit) {
            EXPECT_THAT(usual.notes, testing::Contains(note));
            EXPECT_THAT(usual.notes, testing::Contains(HasSubstr("only the environment lights")));
            EXPECT_THAT(usual.scene().directional_lights, IsEmpty());
        } else {
            EXPECT_THAT(usual.notes, testing::Not(testing::Contains(note)));
            EXPECT_EQ(usual.scene().directional_lights.size(), 2U);
        }
        options.environment = {"none"};
        const ComposedScene without = composed(options);
        EXPECT_FALSE(without.scene().environment);
        EXPECT_EQ(without.scene().directional_lights.size(), 2U);
        options.environment.clear();
        options.shading = SceneOptions::MaterialModel::phong;
        EXPECT_FALSE(composed(options).scene().environment) << "Phong's surfaces scatter light";
    }
}

TEST(SceneOptions, SceneFilesHaveTheEnvironmentThatTheyState) {
    const Workplace workplace;
    write_triangle(workplace, "paint.gltf", R"("pbrMetallicRoughness": {})");
    workplace.write("scene.json", R"({"relief_scene": 1, "nodes": [{"model": "paint.gltf"}]})");
    EXPECT_FALSE(composed(of(workplace / "scene.json")).scene().environment);
    workplace.write("lit.json", R"({"relief_scene": 1, "nodes": [{"model": "paint.gltf"}],
        "environment": {"studio": true}})");
    ViewOptions options = of(workplace / "lit.json");
    EXPECT_TRUE(composed(options).scene().environment);
    options.environment = {"none"};
    EXPECT_FALSE(composed(options).scene().environment);
}

TEST(SceneOptions, AGuessedLightProbeIsNoted) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    write_image(workplace / "square.png", make_image(8, 8, 3, 8, ColorSpace::srgb));
    ViewOptions options = of(workplace / "square.obj");
    options.environment = {workplace / "square.png"};
    EXPECT_THAT(composed(options).notes,
                testing::Contains(HasSubstr("square.png is square, so it counts as an angular "
                                            "light probe; --environment-layout")));
    options.environment_layout = EnvironmentLayout::probe;
    EXPECT_THAT(composed(options).notes, testing::Not(testing::Contains(HasSubstr("probe"))));
}

TEST(SceneOptions, AmbientLightOfALightIsReplacedWithIt) {
    const Workplace workplace;
    workplace.write("scene.json",
                    R"({"relief_scene": 1, "nodes": [{"shape": "quad"}], "ambient": 0.25,
        "lights": [{"type": "point", "ambient": 0.5}]})");
    ViewOptions options = of(workplace / "scene.json");
    EXPECT_EQ(ambient_light(composed(options).scene()), glm::vec3(0.75F));
    options.lights = {parse_light("--light", "point:0,0,1,2,#ffffff,0.125")};
    EXPECT_EQ(ambient_light(composed(options).scene()), glm::vec3(0.5F));
    options.scene_fields.set(&Scene::ambient, glm::vec3(0.0F));
    EXPECT_EQ(ambient_light(composed(options).scene()), glm::vec3(0.25F));
}

TEST(SceneOptions, TermsAreClampedAndTintedOnRequest) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    ViewOptions options = of(workplace / "square.obj");
    options.environment = {"studio"};
    options.material_fields.set(&Material::environment_tint, true);
    options.scene_fields.set(&Scene::clamp_terms, true);
    const Scene scene = composed(options).scene();
    EXPECT_TRUE(scene.clamp_terms);
    ASSERT_EQ(scene.materials.size(), 1U);
    EXPECT_TRUE(scene.materials[0].environment_tint);
    EXPECT_EQ(reason_for_phong(options), "--environment-tint");
}

TEST(SceneOptions, LightsOnTheCommandLineReplaceAllOthers) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    ViewOptions options = of(workplace / "square.obj");
    options.lights = {PointLight{}};
    const ComposedScene lit = composed(options);
    EXPECT_THAT(lit.scene().directional_lights, IsEmpty());
    ASSERT_EQ(lit.scene().point_lights.size(), 1U);
    EXPECT_EQ(lit.scene().ambient, glm::vec3(0.0F));
    EXPECT_THAT(lit.notes, IsEmpty());
}

/// The tolerance for sines and cosines in float.
constexpr double light_tolerance = 1e-5;

template <typename Light>
Light parsed(const std::string& text) {
    return std::get<Light>(parse_light("--light " + text, text));
}

std::string light_refusal(const std::string& text) {
    try {
        parse_light("--light " + text, text);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(LightOption, DirectionalLightHasItsDirection) {
    // From the right (+x), so it travels to the left.
    const auto right = parsed<DirectionalLight>("directional:90,0");
    EXPECT_LT(degrees_between(right.direction_world, {-1, 0, 0}), light_tolerance);
    EXPECT_EQ(right.irradiance, glm::vec3(1.0F));
    const auto above = parsed<DirectionalLight>("directional:0,90,2.5");
    EXPECT_LT(degrees_between(above.direction_world, {0, -1, 0}), light_tolerance);
    EXPECT_EQ(above.irradiance, glm::vec3(2.5F));
    const auto front = parsed<DirectionalLight>("directional:0,0,2,#ff0000");
    EXPECT_LT(degrees_between(front.direction_world, {0, 0, -1}), light_tolerance);
    EXPECT_EQ(front.irradiance, glm::vec3(2.0F, 0.0F, 0.0F));
    EXPECT_EQ(front.ambient, glm::vec3(0.0F));
    const auto around = parsed<DirectionalLight>("directional:0,0,2,#ff0000,0.25");
    EXPECT_EQ(around.ambient, glm::vec3(0.5F, 0.0F, 0.0F));
}

TEST(LightOption, PointLightHasItsPosition) {
    const auto light = parsed<PointLight>("point:1,-2,3.5,4,#0000ff");
    EXPECT_EQ(light.position_world, glm::vec3(1.0F, -2.0F, 3.5F));
    EXPECT_EQ(light.intensity, glm::vec3(0.0F, 0.0F, 4.0F));
    EXPECT_FALSE(light.range);
}

TEST(LightOption, ASpotLightShinesAtItsTargetWithinItsCone) {
    const auto light = parsed<SpotLight>("spot:0,5,0,0,0,0,40,10");
    EXPECT_LT(degrees_between(light.direction_world, {0, -1, 0}), light_tolerance);
    EXPECT_FLOAT_EQ(light.outer_cone, glm::radians(40.0F));
    EXPECT_FLOAT_EQ(light.inner_cone, glm::radians(30.0F));
    EXPECT_EQ(light.point.intensity, glm::vec3(10.0F));
    EXPECT_EQ(parsed<SpotLight>("spot:0,5,0,0,0,0,40,10,#ffffff,0.5").point.ambient,
              glm::vec3(5.0F));
    EXPECT_FLOAT_EQ(parsed<SpotLight>("spot:0,5,0,0,0,0").outer_cone, glm::radians(30.0F));
}

TEST(LightOption, NoneRemovesLights) {
    EXPECT_TRUE(std::holds_alternative<NoLight>(parse_light("--light none", "none")));
}

TEST(LightOption, RefusesInvalidLights) {
    EXPECT_EQ(light_refusal("sun"), "--light sun: not a light");
    EXPECT_EQ(light_refusal("sun:1,2"), "--light sun:1,2: not a light");
    EXPECT_EQ(light_refusal("point"), "--light point: '': not a number");
    EXPECT_EQ(light_refusal("point:1,2"), "--light point:1,2: too few values");
    EXPECT_EQ(light_refusal("point:1,2,x"), "--light point:1,2,x: 'x': not a number");
    EXPECT_EQ(light_refusal("point:1,2,3,-1"),
              "--light point:1,2,3,-1: '-1': not between 0 and 1000000000");
    EXPECT_EQ(light_refusal("point:1,2,3,1,#fff"),
              "--light point:1,2,3,1,#fff: '#fff': not a color like #ff8000");
    EXPECT_EQ(light_refusal("directional:0,0,1,#ffffff,9,9"),
              "--light directional:0,0,1,#ffffff,9,9: too many values");
    EXPECT_EQ(light_refusal("point:0,0,1,1,#ffffff,-1"),
              "--light point:0,0,1,1,#ffffff,-1: '-1': not between 0 and 1000");
    EXPECT_EQ(light_refusal("directional:0,91"),
              "--light directional:0,91: '91': not between -90 and 90 degrees");
    EXPECT_EQ(
        light_refusal("spot:1,1,1,1,1,1"),
        "--light spot:1,1,1,1,1,1: the position and the target of the spotlight are the same");
}

}  // namespace
}  // namespace relief::tools
