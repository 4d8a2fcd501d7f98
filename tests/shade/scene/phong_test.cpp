// SPDX-License-Identifier: Apache-2.0
// Metallic-roughness and MTL as Phong: by hand, and against the integrals that the rule stands for.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "relief/shade/scene_file.h"

namespace relief {
namespace {

GltfMaterial surface(float metallic, float roughness) {
    GltfMaterial material;
    material.name = "surface";
    material.base_color = {0.8F, 0.5F, 0.2F, 1.0F};
    material.metallic = metallic;
    material.roughness = roughness;
    return material;
}

constexpr float color_rounding = 1e-6F;

void expect_color(const glm::vec3& a, const glm::vec3& b, float tolerance = color_rounding) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(a[i], b[i], tolerance) << i;
}

TEST(PhongFromMetallicRoughness, OfARoughDielectricIsDiffuse) {
    const Material phong = phong_from_metallic_roughness(surface(0, 1), {});
    expect_color(phong.diffuse, {0.8F, 0.5F, 0.2F});
    EXPECT_EQ(phong.shininess, 0.0F);                // 2 / 1 - 2.
    expect_color(phong.specular, glm::vec3(0.01F));  // 0.04 * 2 / 8.
    expect_color(phong.ambient, {0.84F, 0.54F, 0.24F});
    EXPECT_LT(phong.reflectivity.x, 2e-4F);
    EXPECT_LT(phong.grazing_reflectivity.x, 0.003F);
}

TEST(PhongFromMetallicRoughness, OfASmoothMetalIsAColouredMirror) {
    const Material phong = phong_from_metallic_roughness(surface(1, 0), {});
    expect_color(phong.diffuse, glm::vec3(0.0F));
    expect_color(phong.reflectivity, {0.8F, 0.5F, 0.2F}, 0.002F);
    EXPECT_NEAR(phong.grazing_reflectivity.x, 1.0F, 0.002F);
    expect_color(phong.ambient, {0.8F, 0.5F, 0.2F});  // It reflects what comes from everywhere.
    EXPECT_LT(phong.shininess, 1e6F);
}

TEST(PhongFromMetallicRoughness, OfARoughMetalIsNoMirror) {
    const Material phong = phong_from_metallic_roughness(surface(1, 0.5F), {});
    // alpha^2 = 1/16: shininess 30, specular F0 * 4, mirror tan^2 / (tan^2 + 1/16).
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
        // Radiance over irradiance / pi of the peak is pi F0 D / 4.
        const double expected = std::numbers::pi * 0.8 * ggx_peak / 4.0;
        EXPECT_NEAR(static_cast<double>(phong.specular.x) / expected, 1.0, 1e-5);
    }
}

TEST(PhongFromMetallicRoughness, MirrorsTheShareOfFacetsWithinThreeDegrees) {
    // The integral of GGX's D (n.h) over the cone, by 20000 steps of the midpoint rule.
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

TEST(PhongFromMetallicRoughness, TakesTexturesByTheirMeans) {
    const TextureMeans means{{0.5F, 0.5F, 1.0F}, 0.5F, 0.5F};
    const Material phong = phong_from_metallic_roughness(surface(1, 1), means);
    EXPECT_NEAR(phong.shininess, 30.0F, 1e-4F);
    expect_color(phong.diffuse, {0.4F, 0.25F, 0.1F});  // The texture itself multiplies later.
    expect_color(phong.specular / 4.0F, {0.22F, 0.145F, 0.12F}, 1e-5F);
}

TEST(PhongFromMetallicRoughness, KeepsWhatPhongHas) {
    GltfMaterial material = surface(0, 0.5F);
    material.emission = {1, 2, 3};
    material.double_sided = true;
    material.unlit = true;
    const Material phong = phong_from_metallic_roughness(material, {});
    EXPECT_EQ(phong.name, "surface");
    expect_color(phong.emission, {1, 2, 3});
    EXPECT_TRUE(phong.double_sided);
    EXPECT_TRUE(phong.unlit);
    material.metallic = 1;  // Unlit shows the base colour, metal or not.
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
    EXPECT_EQ(with(3).grazing_reflectivity, mtl.specular);  // No Fresnel.
    EXPECT_EQ(with(5).grazing_reflectivity, glm::vec3(1.0F));
    EXPECT_EQ(with(2).ambient, mtl.ambient);
    EXPECT_EQ(with(2).shininess, 50.0F);
    EXPECT_TRUE(with(2).double_sided);
}

TEST(PhongFromMtl, BlendsOrRefractsWhatIsNotSolid) {
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

}  // namespace
}  // namespace relief
