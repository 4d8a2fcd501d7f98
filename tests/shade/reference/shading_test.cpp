// SPDX-License-Identifier: Apache-2.0
// The shading formulas of the CPU reference that all materials share and those of Phong's model,
// term by term, against hand-computed values (traced.h). Tests of metallic-roughness stand in
// metallic_roughness_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "reference/reference_parts.h"
#include "shade/effects/feature_sets.h"
#include "shade/reference/traced.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::shade;

namespace {

using test::expect_near;
using test::in_the_corner;
using test::in_the_middle;
using test::linear_texel;
using test::storage_rounding;

TEST(ReferenceShading, AmbientIsLightTimesTintTimesOcclusion) {
    Material material = test::black_material();
    material.ambient = {0.5F, 0.25F, 1.0F};
    material.occlusion_texture = Texture{0};
    material.occlusion_strength = 0.5F;
    Scene scene = test::square_scene(material);
    scene.images = {{"occlusion", linear_texel({0.25F, 1, 1, 1})}};
    scene.ambient = {2.0F, 2.0F, 0.5F};
    scene.meshes[0].edit().colors.assign(4, {0.5F, 1.0F, 1.0F, 1.0F});
    const double occlusion = 1.0 + 0.5 * (0.25 - 1.0);
    expect_near(in_the_middle(scene), occlusion * glm::dvec3(0.5, 0.5, 0.5));
}

TEST(ReferenceShading, AmbientLightIncludesThatOfLightsThatAreOn) {
    Material material = test::black_material();
    material.ambient = glm::vec3(0.5F);
    Scene scene = test::square_scene(material);
    scene.ambient = {0.25F, 0.0F, 0.0F};
    scene.directional_lights.resize(2);
    scene.directional_lights[0].ambient = {0.0F, 0.5F, 0.0F};
    scene.directional_lights[1].ambient = glm::vec3(8.0F);
    scene.directional_lights[1].on = false;
    scene.point_lights.resize(1);
    scene.point_lights[0].ambient = {0.0F, 0.0F, 0.125F};
    scene.spot_lights.resize(1);
    scene.spot_lights[0].point.ambient = {1.0F, 0.0F, 0.0F};
    EXPECT_EQ(ambient_light(scene), glm::vec3(1.25F, 0.5F, 0.125F));
    expect_near(in_the_middle(scene), {0.625, 0.25, 0.0625});
    scene.spot_lights[0].point.on = false;
    expect_near(in_the_middle(scene), {0.125, 0.25, 0.0625});
}

TEST(ReferenceShading, LightThatIsOffHasNoEffect) {
    Material material = test::black_material();
    material.diffuse = material.specular = glm::vec3(1.0F);
    material.shininess = 0.0F;
    Scene scene = test::square_scene(material);
    scene.directional_lights = {{{0, 0, -1}, {1, 1, 1}}};
    scene.point_lights = {{{0, 0, 1}, {1, 1, 1}}};
    scene.spot_lights = {{{{0, 0, 1}, {1, 1, 1}}, {0, 0, -1}}};
    expect_near(in_the_middle(scene), glm::dvec3(6.0));
    scene.directional_lights[0].on = false;
    expect_near(in_the_middle(scene), glm::dvec3(4.0));
    scene.point_lights[0].on = scene.spot_lights[0].point.on = false;
    expect_near(in_the_middle(scene), glm::dvec3(0.0));
}

TEST(ReferenceShading, TermsAreClampedBeforeTheSum) {
    Material material = test::black_material();
    material.ambient = {0.5F, 0.25F, 1.0F};
    material.diffuse = {1.0F, 0.5F, 0.25F};
    material.specular = glm::vec3(3.0F, 0.5F, 0.0F);
    material.shininess = 0.0F;
    material.emission = {0.0F, 0.0F, 5.0F};
    Scene scene = test::square_scene(material);
    scene.ambient = glm::vec3(4.0F);
    scene.directional_lights = {{{0, 0, -1}, {1.5F, 1, 1}}, {{0, 0, -1}, {1, 1, 1}}};
    scene.meshes[0].edit().colors.assign(4, glm::vec4(0.5F, 0.5F, 0.5F, 1.0F));
    // Ambient 2, 1, 4; diffuse 1.5 and 1, 0.5 twice, 0.25 twice; highlights 4.5 and 3, 0.5 twice,
    // 0.
    expect_near(in_the_middle(scene), {0.5 * (2 + 2.5) + 7.5, 0.5 * 2 + 1, 0.5 * 4.5 + 5});
    scene.clamp_terms = true;
    expect_near(in_the_middle(scene), {0.5 * 3 + 2, 0.5 * 2 + 1, 0.5 * 1.5 + 1});
}

TEST(ReferenceShading, AnEnvironmentTintMultipliesScatteredLightAndHighlights) {
    Material material = test::black_material();
    material.ambient = glm::vec3(0.5F);
    material.diffuse = glm::vec3(0.25F);
    material.specular = glm::vec3(0.125F);
    material.shininess = 0.0F;
    material.emission = glm::vec3(0.0625F);
    material.environment_tint = true;
    Scene scene = test::square_scene(material);
    scene.ambient = glm::vec3(1.0F);
    scene.directional_lights = {{{0, 0, -1}, {1, 1, 1}}};
    expect_near(in_the_middle(scene), glm::dvec3(0.9375));  // There is no environment.
    scene.environment = test::constant_environment({0.5F, 1.0F, 2.0F}, false);
    expect_near(in_the_middle(scene), 0.875 * glm::dvec3(0.5, 1, 2) + 0.0625);
}

TEST(ReferenceShading, DiffuseIsTheCosine) {
    Material material = test::black_material();
    material.diffuse = {1.0F, 0.5F, 0.25F};
    material.occlusion_texture = Texture{0};  // Occlusion affects only the environment, not the
                                              // lights.
    Scene scene = test::square_scene(material);
    scene.images = {{"occlusion", linear_texel({0.25F, 1, 1, 1})}};
    scene.directional_lights = {{{-3, 0, -4}, {1, 1, 2}}, {{0, 0, 1}, {9, 9, 9}}};
    expect_near(in_the_middle(scene), {0.8, 0.4, 0.4});
}

TEST(ReferenceShading, PointLightsHaveTheirFalloff) {
    Material material = test::black_material();
    material.diffuse = glm::vec3(1.0F);
    Scene scene = test::square_scene(material);
    PointLight lamp{{0, 3, 4}, {50, 50, 50}};
    const auto lit = [&] {
        scene.point_lights = {lamp};
        return in_the_middle(scene).r;
    };
    EXPECT_NEAR(lit(), 50.0 / 25 * 0.8, storage_rounding);
    lamp.range = 10.0F;
    EXPECT_NEAR(lit(), (1.0 - 1.0 / 16) * 50.0 / 25 * 0.8, storage_rounding);
    lamp.falloff = Falloff::none;
    EXPECT_NEAR(lit(), (1.0 - 1.0 / 16) * 50.0 * 0.8, 50 * storage_rounding);
    lamp.range = 5.0F;
    EXPECT_EQ(lit(), 0.0);
    lamp.range.reset();
    EXPECT_NEAR(lit(), 50.0 * 0.8, 50 * storage_rounding);
}

TEST(ReferenceShading, SpotLightFadesBetweenItsCones) {
    Material material = test::black_material();
    material.diffuse = glm::vec3(1.0F);
    Scene scene = test::square_scene(material);
    // The angle between the axis and the direction to the origin is acos(0.8).
    SpotLight spot{{{0, 3, 4}, {25, 25, 25}}, {0, 0, -1}, 0.0F, 1.0F};
    const double outer = std::cos(1.0);
    const double share = (0.8 - outer) / (1.0 - outer);
    scene.spot_lights = {spot};
    EXPECT_NEAR(in_the_middle(scene).r, 0.8 * share * share, storage_rounding);
    spot.outer_cone = 0.6F;  // acos(0.8) is 0.6435.
    scene.spot_lights = {spot};
    EXPECT_EQ(in_the_middle(scene).r, 0.0);
    spot.outer_cone = 1.5F;
    spot.inner_cone = 0.7F;
    scene.spot_lights = {spot};
    EXPECT_NEAR(in_the_middle(scene).r, 0.8, storage_rounding);
}

TEST(ReferenceShading, TouchingLightIsFinite) {
    Material material = test::black_material();
    material.diffuse = glm::vec3(1.0F);
    Scene scene = test::square_scene(material);
    scene.point_lights = {{{0, 0, 0}, {1, 1, 1}}};
    EXPECT_EQ(in_the_middle(scene).r, 0.0);
    scene.point_lights = {{{0, 0, 1e-12F}, {1, 1, 1}}};
    EXPECT_LE(in_the_middle(scene).r, static_cast<double>(max_light));
}

TEST(ReferenceShading, HighlightsFollowEachModel) {
    Material material = test::black_material();
    material.specular = {1.0F, 0.5F, 0.25F};
    material.shininess = 6.0F;
    Scene scene = test::square_scene(material);
    // The light is 60 degrees from the normal and the eye: r.v is 1/2, n.h the cosine of 30
    // degrees.
    scene.directional_lights = {{{-std::sqrt(3.0F), 0, -1}, {2, 2, 2}}};
    const glm::dvec3 by_channel(2.0, 1.0, 0.5);
    material.specular_model = SpecularModel::phong;
    scene.materials = {material};
    expect_near(in_the_middle(scene), by_channel * std::pow(0.5, 6.0));
    material.specular_model = SpecularModel::blinn_phong;
    scene.materials = {material};
    expect_near(in_the_middle(scene), by_channel * std::pow(0.75, 3.0));
    material.specular_model = SpecularModel::blinn_phong_normalized;
    scene.materials = {material};
    expect_near(in_the_middle(scene), by_channel * std::pow(0.75, 3.0));  // (6 + 2) / 8 is 1.
    material.shininess = 14.0F;
    scene.materials = {material};
    expect_near(in_the_middle(scene), by_channel * 2.0 * std::pow(0.75, 7.0));
    // Schlick's factor at the half vector, 30 degrees from the eye.
    material.highlight_fresnel = true;
    scene.materials = {material};
    const glm::dvec3 specular(material.specular);
    const glm::dvec3 color =
        specular + (1.0 - specular) * std::pow(1.0 - std::sqrt(3.0) / 2.0, 5.0);
    expect_near(in_the_middle(scene), 2.0 * color * 2.0 * std::pow(0.75, 7.0));
}

TEST(ReferenceShading, HighlightsHaveTheirTextureAndLightColor) {
    Material material = test::black_material();
    material.specular = glm::vec3(1.0F);
    material.diffuse = glm::vec3(1.0F);
    material.shininess = 0.0F;
    material.specular_texture = Texture{0};
    Scene scene = test::square_scene(material);
    scene.images = {{"specular", linear_texel({0.5F, 1.0F, 0.25F, 1})}};
    // Vertex colors do not affect highlights.
    scene.meshes[0].edit().colors.assign(4, {0.5F, 0.5F, 0.5F, 1.0F});
    scene.directional_lights = {{{0, 0, -1}, {1, 1, 1}, glm::vec3(4, 0, 8)}};
    expect_near(in_the_middle(scene), glm::dvec3(0.5) + glm::dvec3(2, 0, 2));
    scene.directional_lights.clear();
    scene.point_lights = {
        {{0, 0, 2}, {1, 1, 1}, std::nullopt, Falloff::inverse_square, glm::vec3(16, 0, 32)}};
    expect_near(in_the_middle(scene), glm::dvec3(0.125) + glm::dvec3(2, 0, 2));
}

TEST(ReferenceShading, ExponentOfZeroIsConstantInFrontOfALight) {
    Material material = test::black_material();
    material.specular = glm::vec3(1.0F);
    material.shininess = 0.0F;
    for (const SpecularModel model : {SpecularModel::phong, SpecularModel::blinn_phong}) {
        material.specular_model = model;
        Scene scene = test::square_scene(material);
        scene.directional_lights = {{{-100, 0, -1}, {1, 1, 1}}, {{0, 0, 1}, {1, 1, 1}}};
        expect_near(in_the_middle(scene), glm::dvec3(1.0));
    }
}

TEST(ReferenceShading, ReflectionReducesScatteredLight) {
    Material material = test::black_material();
    material.ambient = glm::vec3(1.0F);
    material.reflectivity = {0.04F, 0.5F, 1.0F};
    material.grazing_reflectivity = {1.0F, 0.5F, 1.0F};
    Scene scene = test::square_scene(material);
    scene.ambient = glm::vec3(0.5F);
    expect_near(in_the_corner(scene), glm::dvec3(0.5));  // There is no environment, so F is 0.
    scene.environment = test::constant_environment({2.0F, 2.0F, 2.0F}, false);
    const double m = std::pow(1.0 - 3.0 / std::sqrt(11.0), 5.0);
    const glm::dvec3 f(0.04 + 0.96 * m, 0.5, 1.0);
    expect_near(in_the_corner(scene), (1.0 - f) * 0.5 + f * 2.0);
    scene.materials[0].reflection_roughness = 0.5F;  // A constant environment gives the same
                                                     // result.
    expect_near(in_the_corner(scene), (1.0 - f) * 0.5 + f * 2.0);
}

/// Six faces with one color each: +x 1, -x 2, +y 3, -y 4, +z 5, -z 6.
Environment numbered_faces() {
    CubeFaces faces;
    for (std::size_t i = 0; i < 6; ++i) {
        // A texel is smaller than the distance of the tested directions to edges, where lookups mix
        // faces.
        Image face = make_image(32, 32, 1, 32, ColorSpace::linear);
        face.samples = std::vector<float>(32UL * 32UL, static_cast<float>(i + 1));
        faces.faces[i] = {"face", face};
    }
    Environment environment{faces};
    environment.skybox = false;
    return environment;
}

TEST(ReferenceShading, ReflectionUsesTheMirroredDirection) {
    Material material = test::black_material();
    material.reflectivity = material.grazing_reflectivity = glm::vec3(1.0F);
    Scene scene = test::square_scene(material);
    scene.environment = numbered_faces();
    expect_near(in_the_middle(scene), glm::dvec3(5));
    // The normal is tilted to the right by 60 degrees, so the mirror shows the right side, slightly
    // behind.
    scene.meshes[0].edit().normals.assign(4, {std::sqrt(0.75F), 0, 0.5F});
    expect_near(in_the_middle(scene), glm::dvec3(1));
}

TEST(ReferenceShading, TransparentSurfaceRefractsByItsIndex) {
    Material material = test::black_material();
    material.ambient = glm::vec3(1.0F);
    material.transmission = 0.75F;
    Scene scene = test::square_scene(material);
    scene.ambient = glm::vec3(1.0F);
    expect_near(in_the_middle(scene), glm::dvec3(1.0));  // Without an environment there is nothing
                                                         // to show.
    scene.environment = numbered_faces();
    expect_near(in_the_middle(scene), glm::dvec3(0.25 + 0.75 * 6));
    // The normal is tilted to the left by 60 degrees. The straight direction is -z. With index 2,
    // the refracted one is asin(sin(60)/2) = 25.66 degrees from the reversed normal, 34.3 degrees
    // from -z. Without reflection there is no other light.
    scene.meshes[0].edit().normals.assign(4, {-std::sqrt(0.75F), 0, 0.5F});
    expect_near(in_the_middle(scene), glm::dvec3(0.25 + 0.75 * 6));
    scene.meshes[0].edit().normals.assign(4, {-std::sin(1.4F), 0, std::cos(1.4F)});
    scene.materials[0].refractive_index = 3.0F;  // 80.2 degrees become 19.2: 61 degrees from -z
                                                 // towards +x.
    expect_near(in_the_middle(scene), glm::dvec3(0.25 + 0.75 * 1));
    scene.materials[0].refractive_index = 1.0F;
    expect_near(in_the_middle(scene), glm::dvec3(0.25 + 0.75 * 6));
}

TEST(ReferenceShading, EnvironmentLightIsScattered) {
    Material material = test::black_material();
    material.diffuse = {1.0F, 0.5F, 0.25F};
    Scene scene = test::square_scene(material);
    scene.environment = test::constant_environment({2.0F, 2.0F, 2.0F}, false);
    expect_near(in_the_middle(scene), glm::dvec3(0.0));
    scene.environment->lights = true;
    expect_near(in_the_middle(scene), {2.0, 1.0, 0.5});
}

TEST(ReferenceShading, EmissionAndUnlitAreColorTimesTexture) {
    Material material = test::black_material();
    material.emission = {1.0F, 2.0F, 4.0F};
    material.emission_texture = Texture{0};
    Scene scene = test::square_scene(material);
    scene.images = {{"emission", linear_texel({0.5F, 0.25F, 0.125F, 1})}};
    expect_near(in_the_middle(scene), glm::dvec3(0.5));
    scene.materials[0].unlit = true;
    scene.materials[0].diffuse = {0.5F, 0.25F, 1.0F};
    scene.materials[0].diffuse_texture = Texture{0};
    scene.ambient = glm::vec3(1.0F);
    expect_near(in_the_middle(scene), {0.25, 0.0625, 0.125});
    scene.materials[0].metallic_roughness = MetallicRoughness{{1.0F, 1.0F, 0.5F}, 1.0F, 1.0F, {}};
    expect_near(in_the_middle(scene), {0.5, 0.25, 0.0625});
}

TEST(ReferenceShading, LightOppositeTheEyeHasNoHalfVector) {
    Material material = test::black_material();
    material.specular = glm::vec3(1.0F);
    Scene scene = test::square_scene(material);
    scene.meshes[0].edit().normals.assign(4, glm::vec3(0, 0, -1));
    scene.directional_lights = {{{0, 0, 1}, {1, 1, 1}}};
    expect_near(in_the_middle(scene), glm::dvec3(0.0));
    scene.materials[0].metallic_roughness = MetallicRoughness{};
    EXPECT_TRUE(std::isfinite(in_the_middle(scene).r));
}

TEST(ReferenceShading, ByGouraudIsLinearBetweenVertices) {
    Material material = test::black_material();
    material.diffuse = glm::vec3(1.0F);
    material.specular = glm::vec3(1.0F);
    material.shininess = 3.0F;
    material.interpolation = Interpolation::gouraud;
    Scene scene = test::square_scene(material);
    // The light is above the upper right corner, so only this light and corner matter.
    scene.point_lights = {{{2, 2, 1}, {1, 1, 1}}};
    const auto at_corner = [&](double x, double y) {
        const glm::dvec3 way(2 - x, 2 - y, 1);
        const glm::dvec3 light = glm::normalize(way);
        const glm::dvec3 view = glm::normalize(glm::dvec3(-x, -y, 3));
        const double n_dot_h = glm::normalize(light + view).z;
        return (light.z + std::pow(n_dot_h, 3.0)) / glm::dot(way, way);
    };
    // The pixel (1, 0) of 2 x 2, at (1, 1), is at three quarters of the edge between the halves of
    // the square, or just beside it, since the diagonal goes from upper left to lower right. In the
    // triangle of the corners (-2, 2), (2, -2), (2, 2), its weights are 1/4, 1/4, 1/2.
    const double expected =
        0.25 * at_corner(-2, 2) + 0.25 * at_corner(2, -2) + 0.5 * at_corner(2, 2);
    expect_near(in_the_corner(scene), glm::dvec3(expected));
    scene.materials[0].interpolation = Interpolation::per_pixel;
    EXPECT_GT(std::abs(in_the_corner(scene).r - expected), 0.1);
}

TEST(ReferenceShading, ByGouraudShowsBackFacesTheirOwnLight) {
    Material material = test::black_material();
    material.diffuse = glm::vec3(1.0F);
    material.interpolation = Interpolation::gouraud;
    material.double_sided = true;
    Scene scene = test::square_scene(material);
    scene.meshes[0].edit().normals.assign(4, glm::vec3(0, 0, 1));
    for (glm::uvec3& triangle : scene.meshes[0].edit().triangles)
        std::swap(triangle.y, triangle.z);  // Seen from behind, the normal is -z.
    scene.directional_lights = {{{0, 0, -1}, {1, 1, 1}}, {{0, 3, 4}, {2, 2, 2}}};
    expect_near(in_the_middle(scene), glm::dvec3(1.6));
}

/// Rays beside a pixel are compared with the ray of the pixel, which needs the radiance.
TEST(RaysWithoutRadiance, MakeTheSameDecisionsAndLookups) {
    const std::vector<Features>& sets = test::covering_features();
    std::size_t films = 0;
    for (std::size_t i = 0; i < sets.size(); ++i) {
        if (sets[i].transmission) continue;  // It looks up a picture, which is not here.
        SCOPED_TRACE(describe(sets[i]));
        const Scene scene = test::scene_calling_for(sets[i]).scene;
        Report report;
        const reference::PreparedScene prepared(scene, report);
        const Material& material = prepared.material_of(0, 0);
        if (sets[i].iridescence) ++films;
        for (const glm::dvec3 corners : {glm::dvec3(1.0 / 3.0), {0.7, 0.2, 0.1}}) {
            const reference::Hit hit{0, 0, 1.0, corners, true};
            reference::Trace with(true), without(false);
            const reference::Shaded shaded = reference::shade(prepared, hit, material, with);
            EXPECT_EQ(reference::shade(prepared, hit, material, without).alpha, shaded.alpha);
            EXPECT_TRUE(without.decided_like(with));
            EXPECT_EQ(without.places(), with.places());
        }
    }
    EXPECT_GE(films, 2U) << "the phase of a film is a decision";
}

}  // namespace
}  // namespace relief
