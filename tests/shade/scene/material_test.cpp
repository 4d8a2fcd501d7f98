// SPDX-License-Identifier: Apache-2.0
// Materials: the table of classic materials, Phong parameters of metallic-roughness and MTL
// materials, names, and the descriptions of fields.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <set>

#include "relief/shade/frame_settings.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_fields.h"
#include "relief/shade/scene_file.h"
#include "relief/shade/scene_graph.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::shade;

namespace {

using ::testing::HasSubstr;

/// Decodes a color of the table from sRGB (IEC 61966-2-1).
glm::vec3 seen(const glm::vec3& codes) {
    glm::vec3 linear;
    for (int i = 0; i < 3; ++i)
        linear[i] =
            codes[i] <= 0.04045F ? codes[i] / 12.92F : std::pow((codes[i] + 0.055F) / 1.055F, 2.4F);
    return linear;
}

void expect_same_color(const glm::vec3& actual, const glm::vec3& expected) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(actual[i], expected[i], 1e-6F);
}

TEST(MaterialByName, HasTheNumbersOfTheTable) {
    const Material gold = material_by_name("gold").value();
    EXPECT_EQ(gold.name, "gold");
    expect_same_color(gold.ambient, seen(glm::vec3(0.24725F, 0.1995F, 0.0745F)));
    expect_same_color(gold.diffuse, seen(glm::vec3(0.75164F, 0.60648F, 0.22648F)));
    expect_same_color(gold.specular, seen(glm::vec3(0.628281F, 0.555802F, 0.366065F)));
    EXPECT_NEAR(gold.shininess, 51.2F, 1e-5F);
    EXPECT_EQ(gold.specular_model, SpecularModel::phong);
    // The exponents of later printed tables.
    EXPECT_NEAR(material_by_name("brass")->shininess, 27.8974F, 1e-4F);
    EXPECT_NEAR(material_by_name("pewter")->shininess, 9.84615F, 1e-4F);
    EXPECT_NEAR(material_by_name("pearl")->shininess, 11.264F, 1e-4F);
    EXPECT_NEAR(material_by_name("polished silver")->shininess, 89.6F, 1e-4F);
    EXPECT_EQ(material_by_name("black rubber")->shininess, 10.0F);
    expect_same_color(material_by_name("yellow plastic")->diffuse,
                      seen(glm::vec3(0.5F, 0.5F, 0.0F)));
}

TEST(MaterialByName, IgnoresCaseAndSeparators) {
    EXPECT_EQ(material_by_name("Red_Plastic")->name, "red plastic");
    EXPECT_EQ(material_by_name("POLISHED-GOLD")->name, "polished gold");
}

TEST(MaterialByName, IsAbsentForOtherNames) {
    EXPECT_FALSE(material_by_name("gild"));
    EXPECT_FALSE(material_by_name(""));
    EXPECT_FALSE(material_by_name("gold "));
}

TEST(MaterialNames, AreSortedAndAllCanBeDrawn) {
    const std::vector<std::string>& names = material_names();
    EXPECT_EQ(names.size(), 29U);  // 24 teapots, pewter and four polished metals.
    EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
    Scene scene;
    for (const std::string& name : names) {
        scene.materials.push_back(material_by_name(name).value());
        EXPECT_EQ(scene.materials.back().name, name);
    }
    EXPECT_NO_THROW(validate(scene));
}

GltfMaterial surface(float metallic, float roughness) {
    GltfMaterial material;
    material.name = "surface";
    material.metallic_roughness = {{0.8F, 0.5F, 0.2F}, metallic, roughness, {}};
    return material;
}

constexpr float color_rounding = 1e-6F;

void expect_color(const glm::vec3& a, const glm::vec3& b, float tolerance = color_rounding) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(a[i], b[i], tolerance) << i;
}

TEST(PhongFromMetallicRoughness, RoughDielectricIsDiffuse) {
    const Material phong = phong_from_metallic_roughness(surface(0, 1), {});
    expect_color(phong.diffuse, {0.8F, 0.5F, 0.2F});
    EXPECT_EQ(phong.shininess, 0.0F);                // 2 / 1 - 2.
    expect_color(phong.specular, glm::vec3(0.01F));  // 0.04 * 2 / 8.
    expect_color(phong.ambient, {0.84F, 0.54F, 0.24F});
    EXPECT_LT(phong.reflectivity.x, 2e-4F);
    EXPECT_LT(phong.grazing_reflectivity.x, 0.003F);
}

TEST(PhongFromMetallicRoughness, HasTheReflectanceOfTheDielectric) {
    GltfMaterial dense = surface(0, 1);
    dense.metallic_roughness->refractive_index = 3.0F;  // Reflects 1/4.
    dense.metallic_roughness->specular = 0.5F;
    dense.metallic_roughness->specular_color = {1.0F, 0.5F, 8.0F};
    const Material phong = phong_from_metallic_roughness(dense, {});
    expect_color(phong.specular, glm::vec3(0.125F, 0.0625F, 0.5F) / 4.0F);
    expect_color(phong.ambient, {0.925F, 0.5625F, 0.7F});
    const Material plain = phong_from_metallic_roughness(surface(0, 1), {});
    expect_color(phong.grazing_reflectivity, 0.5F * plain.grazing_reflectivity);
}

TEST(PhongFromMetallicRoughness, SmoothMetalIsAColoredMirror) {
    const Material phong = phong_from_metallic_roughness(surface(1, 0), {});
    expect_color(phong.diffuse, glm::vec3(0.0F));
    expect_color(phong.reflectivity, {0.8F, 0.5F, 0.2F}, 0.002F);
    EXPECT_NEAR(phong.grazing_reflectivity.x, 1.0F, 0.002F);
    expect_color(phong.ambient, {0.8F, 0.5F, 0.2F});  // The surface reflects ambient light.
    EXPECT_LT(phong.shininess, 1e6F);
}

TEST(PhongFromMetallicRoughness, RoughMetalIsNotAMirror) {
    const Material phong = phong_from_metallic_roughness(surface(1, 0.5F), {});
    // With alpha^2 = 1/16, the shininess is 30, the specular color F0 * 4, and the mirror
    // reflection tan^2 / (tan^2 + 1/16).
    EXPECT_NEAR(phong.shininess, 30.0F, 1e-4F);
    expect_color(phong.specular, {3.2F, 2.0F, 0.8F}, 1e-5F);
    EXPECT_NEAR(phong.grazing_reflectivity.x, 0.0421F, 1e-4F);
}

TEST(PhongFromMetallicRoughness, HasGgxsPeak) {
    for (const double roughness : {0.2, 0.5, 0.9}) {
        const Material phong =
            phong_from_metallic_roughness(surface(1, static_cast<float>(roughness)), {});
        const double alpha = roughness * roughness;
        const double ggx_peak = 1.0 / (std::numbers::pi * alpha * alpha);
        // At the peak, radiance divided by irradiance / pi is pi F0 D / 4.
        const double expected = std::numbers::pi * 0.8 * ggx_peak / 4.0;
        EXPECT_NEAR(static_cast<double>(phong.specular.x) / expected, 1.0, 1e-5);
    }
}

TEST(PhongFromMetallicRoughness, ReflectsTheFractionOfFacetsWithinThreeDegrees) {
    // The integral of D (n.h) of GGX over the cone, with 20000 steps of the midpoint rule.
    for (const double roughness : {0.1, 0.3, 0.7}) {
        const double alpha_squared = std::pow(roughness, 4.0);
        const double limit = 3.0 * std::numbers::pi / 180.0;
        constexpr int steps = 20000;
        double share = 0.0;
        for (int i = 0; i < steps; ++i) {
            const double theta = limit * (i + 0.5) / steps;
            const double c = std::cos(theta);
            const double below = c * c * (alpha_squared - 1.0) + 1.0;
            const double d = alpha_squared / (std::numbers::pi * below * below);
            share += 2.0 * std::numbers::pi * d * c * std::sin(theta) * limit / steps;
        }
        const Material phong =
            phong_from_metallic_roughness(surface(1, static_cast<float>(roughness)), {});
        EXPECT_NEAR(static_cast<double>(phong.grazing_reflectivity.x), share, 1e-4) << roughness;
    }
}

TEST(PhongFromMetallicRoughness, UsesMeansOfTextures) {
    const TextureMeans means{{0.5F, 0.5F, 1.0F}, 0.5F, 0.5F};
    const Material phong = phong_from_metallic_roughness(surface(1, 1), means);
    EXPECT_NEAR(phong.shininess, 30.0F, 1e-4F);
    expect_color(phong.diffuse, {0.4F, 0.25F, 0.1F});  // The texture is multiplied later.
    expect_color(phong.specular / 4.0F, {0.22F, 0.145F, 0.12F}, 1e-5F);
}

TEST(PhongFromMetallicRoughness, KeepsSharedFields) {
    GltfMaterial material = surface(0, 0.5F);
    material.emission = {1, 2, 3};
    material.double_sided = true;
    material.unlit = true;
    const Material phong = phong_from_metallic_roughness(material, {});
    EXPECT_EQ(phong.name, "surface");
    expect_color(phong.emission, {1, 2, 3});
    EXPECT_TRUE(phong.double_sided);
    EXPECT_TRUE(phong.unlit);
    material.metallic_roughness->metallic = 1;  // Unlit shows the base color, even of a metal.
    expect_color(phong_from_metallic_roughness(material, {}).diffuse, {0.8F, 0.5F, 0.2F});
}

TEST(PhongFromMetallicRoughness, IsValidForEveryFactor) {
    Scene scene;
    for (const float metallic : {-1.0F, 0.0F, 0.5F, 1.0F, 9.0F, std::nanf("")}) {
        for (const float roughness : {-1.0F, 0.0F, 1e-20F, 0.5F, 1.0F, 9.0F}) {
            scene.materials.push_back(
                phong_from_metallic_roughness(surface(metallic, roughness), {}));
        }
    }
    EXPECT_NO_THROW(validate(scene));
}

TEST(PhongFromMtl, FollowsTheIlluminationModel) {
    MtlMaterial mtl;
    mtl.name = "paint";
    mtl.ambient = {0.1F, 0.1F, 0.1F};
    mtl.diffuse = {0.5F, 0.6F, 0.7F};
    mtl.specular = {0.25F, 0.5F, 0.75F};
    mtl.shininess = 50;
    const auto with = [&](int model) {
        mtl.illumination_model = model;
        return phong_from_mtl(mtl);
    };
    EXPECT_TRUE(with(0).unlit);
    EXPECT_EQ(with(1).specular, glm::vec3(0.0F));
    EXPECT_EQ(with(2).specular, mtl.specular);
    EXPECT_EQ(with(2).reflectivity, glm::vec3(0.0F));
    EXPECT_EQ(with(3).reflectivity, mtl.specular);
    EXPECT_EQ(with(3).grazing_reflectivity, mtl.specular);  // There is no Fresnel effect.
    EXPECT_EQ(with(5).grazing_reflectivity, glm::vec3(1.0F));
    EXPECT_EQ(with(2).ambient, mtl.ambient);
    EXPECT_EQ(with(2).shininess, 50.0F);
    EXPECT_TRUE(with(2).double_sided);
    mtl.shininess = 0.0F;
    EXPECT_EQ(with(2).specular, glm::vec3(0.0F)) << "as MeshLab writes it";
    EXPECT_EQ(with(3).specular, glm::vec3(0.0F));
    EXPECT_EQ(with(3).reflectivity, mtl.specular);
}

TEST(PhongFromMtl, BlendsOrRefractsTransparentMaterials) {
    MtlMaterial mtl;
    mtl.opacity = 0.25F;
    mtl.refractive_index = 1.33F;
    for (const int model : {0, 1, 2, 3, 4, 5, 8, 9}) {
        mtl.illumination_model = model;
        const Material phong = phong_from_mtl(mtl);
        EXPECT_EQ(phong.alpha_mode, AlphaMode::blend) << model;
        EXPECT_EQ(phong.opacity, 0.25F) << model;
        EXPECT_EQ(phong.transmission, 0.0F) << model;
    }
    for (const int model : {6, 7}) {
        mtl.illumination_model = model;
        const Material phong = phong_from_mtl(mtl);
        EXPECT_EQ(phong.alpha_mode, AlphaMode::opaque) << model;
        EXPECT_EQ(phong.transmission, 0.75F) << model;
        EXPECT_EQ(phong.refractive_index, 1.33F) << model;
    }
    mtl.opacity = 1.0F;
    mtl.illumination_model = 2;
    EXPECT_EQ(phong_from_mtl(mtl).alpha_mode, AlphaMode::opaque);
    mtl.opacity_map = "holes.png";
    EXPECT_EQ(phong_from_mtl(mtl).alpha_mode, AlphaMode::blend);
}

TEST(PhongFromMtl, IsValidForEveryNumber) {
    MtlMaterial mtl;
    mtl.specular = {5, -1, std::nanf("")};
    mtl.shininess = 1e9F;
    mtl.illumination_model = 3;
    mtl.opacity = std::nanf("");
    mtl.refractive_index = -2.0F;
    Scene scene;
    scene.materials = {phong_from_mtl(mtl)};
    EXPECT_NO_THROW(validate(scene));
    EXPECT_EQ(scene.materials[0].shininess, 1e6F);
    EXPECT_EQ(scene.materials[0].specular, glm::vec3(5, 0, 0));
    EXPECT_EQ(scene.materials[0].opacity, 0.0F);
    EXPECT_EQ(scene.materials[0].refractive_index, 1.0F);
    EXPECT_EQ(scene.materials[0].reflectivity, glm::vec3(1, 0, 0));
}

TEST(Labels, AreNamesOrElseNumbers) {
    Scene scene;
    scene.materials.resize(2);
    scene.materials[0].name = "paint";
    scene.meshes.resize(2);
    scene.meshes[0].edit().name = "Wheel";
    scene.instances = {{0, glm::mat4(1.0F), "left"}, {0, glm::mat4(1.0F), ""}, {1, {}, ""}};
    EXPECT_EQ(material_label(scene, 0), "material 'paint'");
    EXPECT_EQ(material_label(scene, 1), "material 1");
    EXPECT_EQ(material_label(scene, std::nullopt), "the default material");
    EXPECT_EQ(mesh_label(scene, 0), "mesh 'Wheel'");
    EXPECT_EQ(mesh_label(scene, 1), "mesh 1");
    EXPECT_EQ(instance_label(scene, 0), "instance 'left'");
    EXPECT_EQ(instance_label(scene, 1), "mesh 'Wheel'");
    EXPECT_EQ(instance_label(scene, 2), "instance 2");
}

TEST(Labels, OfMissingElementsAreIndices) {
    EXPECT_EQ(material_label(Scene{}, 7), "material 7");
    EXPECT_EQ(instance_label(Scene{}, 7), "instance 7");
    EXPECT_EQ(mesh_label(Scene{}, 7), "mesh 7");
}

std::string document() {
    std::ifstream file(test::source_directory() / "docs/scene-files.md");
    return {std::istreambuf_iterator<char>(file), {}};
}

template <typename T>
class SceneFields : public testing::Test {};

using DescribedTypes =
    testing::Types<Texture, NormalMap, BumpMap, MetallicRoughness, Material, DirectionalLight,
                   PointLight, SpotLight, Environment, Camera, Scene, Orbit, Turntable>;
TYPED_TEST_SUITE(SceneFields, DescribedTypes);

TYPED_TEST(SceneFields, HaveUniqueNamesAndTheDocumentListsThem) {
    const std::string text = document();
    std::set<std::string> names;
    for_each_field<TypeParam>([&](const auto& field) {
        EXPECT_TRUE(names.insert(field.name).second) << field.name;
        EXPECT_THAT(text, HasSubstr(field.name));
    });
    EXPECT_FALSE(names.empty());
}

TYPED_TEST(SceneFields, HaveDefaultsWithinTheirRanges) {
    for_each_field<TypeParam>([](const auto& field) {
        using Value = std::decay_t<decltype(field.default_value())>;
        const Value value = field.default_value();
        if constexpr (std::is_same_v<Value, float>) {
            EXPECT_GE(value, field.range.min) << field.name;
            EXPECT_LE(value, field.range.max) << field.name;
        } else if constexpr (std::is_same_v<Value, glm::vec3>) {
            for (int i = 0; i < 3; ++i) {
                EXPECT_GE(value[i], field.range.min) << field.name;
                EXPECT_LE(value[i], field.range.max) << field.name;
            }
            if (field.unit == FieldUnit::world_direction) {
                EXPECT_NE(value, glm::vec3(0.0F));
            }
        } else if constexpr (std::is_enum_v<Value>) {
            EXPECT_STRNE(enum_name(value), "") << field.name;
        }
    });
}

TEST(SceneField, HasALabelForMessages) {
    std::vector<std::string> labels;
    for_each_field<MetallicRoughness>([&](const auto& field) { labels.push_back(field.label()); });
    EXPECT_THAT(
        labels,
        testing::ElementsAre(
            "base color", "metallic", "roughness", "metallic-roughness texture", "refractive index",
            "specular", "specular color", "specular texture", "specular color texture", "clearcoat",
            "clearcoat roughness", "clearcoat texture", "clearcoat roughness texture",
            "clearcoat normal map", "sheen color", "sheen roughness", "sheen color texture",
            "sheen roughness texture", "anisotropy", "anisotropy rotation", "anisotropy texture",
            "iridescence", "film index", "film thickness", "minimum film thickness",
            "iridescence texture", "iridescence thickness texture", "transmission",
            "transmission texture", "thickness", "thickness texture", "attenuation distance",
            "attenuation color", "dispersion"));
    EXPECT_EQ(outer_cone_field.label(), "outer cone");
}

TEST(SceneField, HasATitleAndARangeForPanels) {
    EXPECT_EQ(field_of(&Material::reflection_roughness).title(), "Reflection roughness");
    EXPECT_EQ(field_of(&Material::refractive_index).range, (FieldRange{1.0F, 1e3F}));
    EXPECT_EQ(field_of(&Material::refractive_index).slider_range, (FieldRange{1.0F, 3.0F}));
    EXPECT_EQ(field_of(&MetallicRoughness::iridescence_thickness).unit, FieldUnit::nanometers);
    EXPECT_EQ(field_of(&MetallicRoughness::roughness).slider_range, (FieldRange{0.0F, 1.0F}));
    EXPECT_EQ(field_of(&SpotLight::outer_cone).unit, FieldUnit::radians);
}

TEST(SceneField, HasASliderOfAcceptedValuesThatGltfPermits) {
    const auto lies_in = [](const FieldRange& inner, const FieldRange& outer) {
        return inner.min >= outer.min && inner.max <= outer.max && inner.min < inner.max;
    };
    const auto check = [&](const auto& field) {
        EXPECT_TRUE(lies_in(field.slider_range, field.range)) << field.name;
        EXPECT_TRUE(lies_in(field.range, field.gltf_range)) << field.name;
    };
    for_each_field<Material>(check);
    for_each_field<MetallicRoughness>(check);
    for_each_field<Environment>(check);
    for_each_field<Shadow>(check);
}

TEST(EnumNames, HaveLabelsForPanels) {
    EXPECT_THAT(enum_labels<ToneMapping>(),
                testing::ElementsAre("None", "Reinhard", "ACES (Narkowicz)", "Khronos PBR Neutral",
                                     "ACES Filmic (Hill)", "ACES Filmic (Hill, exposure boost)"));
    EXPECT_THAT(enum_labels<Interpolation>(),
                testing::ElementsAre("Per pixel", "Per vertex (Gouraud)", "Flat"));
}

TEST(EnumNames, NameEveryValueOnce) {
    EXPECT_STREQ(enum_name(FresnelModel::conductor), "conductor");
    EXPECT_STREQ(enum_name(FlatCode::middle), "128");
    EXPECT_STREQ(enum_name(static_cast<AlphaMode>(17)), "");
}

}  // namespace
}  // namespace relief
