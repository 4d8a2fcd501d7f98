// SPDX-License-Identifier: Apache-2.0
// Material's formula term by term, against numbers worked out by hand: on the facing square, at
// the origin seen from straight in front (the middle pixel of 3 x 3), and at (1, 1, 0), from where
// the eye is at (-1, -1, 3) / sqrt(11) (the upper right pixel of 2 x 2).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reference/lookups.h"
#include "support/shapes.h"
#include "traced.h"

namespace relief {
namespace {

using std::numbers::pi;
using test::storage_rounding;

Scene square(const Material& material) {
    return test::scene_of(test::facing_square(), material);
}

glm::dvec3 in_the_middle(const Scene& scene) {
    return test::radiance_at(scene, 3, 1, 1);
}

glm::dvec3 in_the_corner(const Scene& scene) {
    return test::radiance_at(scene, 2, 1, 0);
}

void expect_near(const glm::dvec3& found, const glm::dvec3& expected) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(found[i], expected[i], storage_rounding * std::max(expected[i], 1.0)) << i;
}

Image texel(const glm::vec4& color, int channels = 3) {
    return test::constant_image(color, channels, 32, ColorSpace::linear);
}

TEST(ReferenceShading, OfAmbientLightIsItsShareTimesTintAndOcclusion) {
    Material material = test::black_material();
    material.ambient = {0.5F, 0.25F, 1.0F};
    material.occlusion_texture = Texture{0};
    material.occlusion_strength = 0.5F;
    Scene scene = square(material);
    scene.images = {{"occlusion", texel({0.25F, 1, 1, 1})}};
    scene.ambient = {2.0F, 2.0F, 0.5F};
    scene.meshes[0].edit().colors.assign(4, {0.5F, 1.0F, 1.0F, 1.0F});
    const double occlusion = 1.0 + 0.5 * (0.25 - 1.0);
    expect_near(in_the_middle(scene), occlusion * glm::dvec3(0.5, 0.5, 0.5));
}

TEST(ReferenceShading, OfDiffuseLightIsTheCosine) {
    Material material = test::black_material();
    material.diffuse = {1.0F, 0.5F, 0.25F};
    material.occlusion_texture = Texture{0};  // Of the surroundings only: lamps are not occluded.
    Scene scene = square(material);
    scene.images = {{"occlusion", texel({0.25F, 1, 1, 1})}};
    scene.directional_lights = {{{-3, 0, -4}, {1, 1, 2}}, {{0, 0, 1}, {9, 9, 9}}};
    expect_near(in_the_middle(scene), {0.8, 0.4, 0.4});
}

TEST(ReferenceShading, OfPointLightsFallsOffAsAsked) {
    Material material = test::black_material();
    material.diffuse = glm::vec3(1.0F);
    Scene scene = square(material);
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

TEST(ReferenceShading, OfASpotLightFadesBetweenItsCones) {
    Material material = test::black_material();
    material.diffuse = glm::vec3(1.0F);
    Scene scene = square(material);
    // The axis misses the origin by acos(0.8).
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

TEST(ReferenceShading, OfALampThatTouchesOrNearlyIsFinite) {
    Material material = test::black_material();
    material.diffuse = glm::vec3(1.0F);
    Scene scene = square(material);
    scene.point_lights = {{{0, 0, 0}, {1, 1, 1}}};
    EXPECT_EQ(in_the_middle(scene).r, 0.0);
    scene.point_lights = {{{0, 0, 1e-12F}, {1, 1, 1}}};
    EXPECT_LE(in_the_middle(scene).r, static_cast<double>(max_light));
}

TEST(ReferenceShading, OfHighlightsFollowsEachModel) {
    Material material = test::black_material();
    material.specular = {1.0F, 0.5F, 0.25F};
    material.shininess = 6.0F;
    Scene scene = square(material);
    // The lamp 60 degrees off the normal and the eye: r.v is 1/2, n.h the cosine of 30 degrees.
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
}

TEST(ReferenceShading, OfHighlightsHasItsOwnTextureAndLampColour) {
    Material material = test::black_material();
    material.specular = glm::vec3(1.0F);
    material.diffuse = glm::vec3(1.0F);
    material.shininess = 0.0F;
    material.specular_texture = Texture{0};
    Scene scene = square(material);
    scene.images = {{"specular", texel({0.5F, 1.0F, 0.25F, 1})}};
    scene.meshes[0].edit().colors.assign(4, {0.5F, 0.5F, 0.5F, 1.0F});  // No say in highlights.
    scene.directional_lights = {{{0, 0, -1}, {1, 1, 1}, glm::vec3(4, 0, 8)}};
    expect_near(in_the_middle(scene), glm::dvec3(0.5) + glm::dvec3(2, 0, 2));
    scene.directional_lights.clear();
    scene.point_lights = {
        {{0, 0, 2}, {1, 1, 1}, std::nullopt, Falloff::inverse_square, glm::vec3(16, 0, 32)}};
    expect_near(in_the_middle(scene), glm::dvec3(0.125) + glm::dvec3(2, 0, 2));
}

TEST(ReferenceShading, OfAnExponentOfZeroShinesWhereverALampIsInFront) {
    Material material = test::black_material();
    material.specular = glm::vec3(1.0F);
    material.shininess = 0.0F;
    for (const SpecularModel model : {SpecularModel::phong, SpecularModel::blinn_phong}) {
        material.specular_model = model;
        Scene scene = square(material);
        scene.directional_lights = {{{-100, 0, -1}, {1, 1, 1}}, {{0, 0, 1}, {1, 1, 1}}};
        expect_near(in_the_middle(scene), glm::dvec3(1.0));
    }
}

TEST(ReferenceShading, OfAReflectionTakesFromWhatIsScattered) {
    Material material = test::black_material();
    material.ambient = glm::vec3(1.0F);
    material.reflectivity = {0.04F, 0.5F, 1.0F};
    material.grazing_reflectivity = {1.0F, 0.5F, 1.0F};
    Scene scene = square(material);
    scene.ambient = glm::vec3(0.5F);
    expect_near(in_the_corner(scene), glm::dvec3(0.5));  // No environment: F is 0.
    scene.environment = test::constant_environment({2.0F, 2.0F, 2.0F}, false);
    const double m = std::pow(1.0 - 3.0 / std::sqrt(11.0), 5.0);
    const glm::dvec3 f(0.04 + 0.96 * m, 0.5, 1.0);
    expect_near(in_the_corner(scene), (1.0 - f) * 0.5 + f * 2.0);
    scene.materials[0].reflection_roughness = 0.5F;  // Of a constant environment, the same.
    expect_near(in_the_corner(scene), (1.0 - f) * 0.5 + f * 2.0);
}

/// Six faces of one colour each: +x 1, -x 2, +y 3, -y 4, +z 5, -z 6.
Environment numbered_faces() {
    CubeFaces faces;
    for (std::size_t i = 0; i < 6; ++i) {
        // Finer than the tests' directions are to edges, across which faces mix.
        Image face = make_image(32, 32, 1, 32, ColorSpace::linear);
        face.samples = std::vector<float>(32UL * 32UL, static_cast<float>(i + 1));
        faces.faces[i] = {"face", face};
    }
    Environment environment{faces};
    environment.skybox = false;
    return environment;
}

TEST(ReferenceShading, OfAReflectionLooksWhereALightWouldHaveToBe) {
    Material material = test::black_material();
    material.reflectivity = material.grazing_reflectivity = glm::vec3(1.0F);
    Scene scene = square(material);
    scene.environment = numbered_faces();
    expect_near(in_the_middle(scene), glm::dvec3(5));
    // Leaning right by 60 degrees, the normal mirrors what is right and a little behind.
    scene.meshes[0].edit().normals.assign(4, {std::sqrt(0.75F), 0, 0.5F});
    expect_near(in_the_middle(scene), glm::dvec3(1));
}

TEST(ReferenceShading, OfATransparentSurfaceBendsTheViewByItsIndex) {
    Material material = test::black_material();
    material.ambient = glm::vec3(1.0F);
    material.transmission = 0.75F;
    Scene scene = square(material);
    scene.ambient = glm::vec3(1.0F);
    expect_near(in_the_middle(scene), glm::dvec3(1.0));  // Without an environment nothing is there.
    scene.environment = numbered_faces();
    expect_near(in_the_middle(scene), glm::dvec3(0.25 + 0.75 * 6));
    // Leaning left by 60 degrees: straight through, -z; bent by 2, asin(sin(60)/2) = 25.66 degrees
    // from the normal's back, 34.3 degrees off -z; and without reflection nothing else.
    scene.meshes[0].edit().normals.assign(4, {-std::sqrt(0.75F), 0, 0.5F});
    expect_near(in_the_middle(scene), glm::dvec3(0.25 + 0.75 * 6));
    scene.meshes[0].edit().normals.assign(4, {-std::sin(1.4F), 0, std::cos(1.4F)});
    scene.materials[0].refractive_index = 3.0F;  // 80.2 degrees, bent to 19.2: 61 off -z, to +x.
    expect_near(in_the_middle(scene), glm::dvec3(0.25 + 0.75 * 1));
    scene.materials[0].refractive_index = 1.0F;
    expect_near(in_the_middle(scene), glm::dvec3(0.25 + 0.75 * 6));
}

TEST(ReferenceShading, OfTheEnvironmentsLightIsScatteredWhereItLights) {
    Material material = test::black_material();
    material.diffuse = {1.0F, 0.5F, 0.25F};
    Scene scene = square(material);
    scene.environment = test::constant_environment({2.0F, 2.0F, 2.0F}, false);
    expect_near(in_the_middle(scene), glm::dvec3(0.0));
    scene.environment->lights = true;
    expect_near(in_the_middle(scene), {2.0, 1.0, 0.5});
}

TEST(ReferenceShading, OfEmissionAndUnlitIsTheColourTimesItsTexture) {
    Material material = test::black_material();
    material.emission = {1.0F, 2.0F, 4.0F};
    material.emission_texture = Texture{0};
    Scene scene = square(material);
    scene.images = {{"emission", texel({0.5F, 0.25F, 0.125F, 1})}};
    expect_near(in_the_middle(scene), glm::dvec3(0.5));
    scene.materials[0].unlit = true;
    scene.materials[0].diffuse = {0.5F, 0.25F, 1.0F};
    scene.materials[0].diffuse_texture = Texture{0};
    scene.ambient = glm::vec3(1.0F);
    expect_near(in_the_middle(scene), {0.25, 0.0625, 0.125});
    scene.materials[0].metallic_roughness = MetallicRoughness{{1.0F, 1.0F, 0.5F}, 1.0F, 1.0F, {}};
    expect_near(in_the_middle(scene), {0.5, 0.25, 0.0625});
}

/// Everything at 45 degrees or less: the lamp in (1, 0, 1) / sqrt(2), the eye in z.
TEST(ReferenceShading, OfMetallicRoughnessIsAppendixB) {
    Material material;
    material.metallic_roughness = MetallicRoughness{{0.5F, 0.25F, 1.0F}, 0.25F, 0.5F, {}};
    Scene scene = square(material);
    scene.directional_lights = {{{-1, 0, -1}, {3, 3, 3}}};
    const double a2 = 0.25 * 0.25;  // alpha squared: roughness to the fourth.
    const double n_dot_l = std::sqrt(0.5);
    const double n_dot_h = std::cos(pi / 8);
    const double d = a2 / (pi * std::pow(n_dot_h * n_dot_h * (a2 - 1.0) + 1.0, 2.0));
    // Heights correlated: with n.v = 1 its root is 1.
    const double v = 0.5 / (n_dot_l * 1.0 + std::sqrt(0.5 + 0.5 * a2));
    const glm::dvec3 b(0.5, 0.25, 1.0);
    const glm::dvec3 f0 = 0.75 * 0.04 + 0.25 * b;
    const glm::dvec3 f = f0 + (1.0 - f0) * std::pow(1.0 - n_dot_h, 5.0);
    expect_near(in_the_middle(scene), 3.0 * n_dot_l * ((1.0 - f) * 0.75 * b + f * (pi * d * v)));
}

/// The normal is turned away from the eye and from the half vector: n.v = -0.6 and n.h = -0.88
/// count as 0.
TEST(ReferenceShading, OfMetallicRoughnessTakesNegativeCosinesAsZero) {
    Material material;
    material.metallic_roughness = MetallicRoughness{glm::vec3(1.0F), 1.0F, 0.5F, {}};
    Scene scene = square(material);
    scene.meshes[0].edit().normals.assign(4, glm::vec3(0.8F, 0.0F, -0.6F));
    scene.directional_lights = {{{0.28F, 0.0F, 0.96F}, glm::vec3(1.0F)}};
    // n.l pi D V f with pi D = alpha^2, V = 1 / (2 n.l alpha), f = 1 and alpha = 0.5^2.
    expect_near(in_the_middle(scene), glm::dvec3(0.5 * 0.25));
}

TEST(ReferenceShading, OfMetallicRoughnessReadsGreenAndBlue) {
    Material material;
    material.metallic_roughness = MetallicRoughness{{0.5F, 0.25F, 1.0F}, 0.5F, 1.0F, Texture{0}};
    Scene scene = square(material);
    scene.images = {{"maps", texel({0.0F, 0.5F, 0.5F, 1})}};
    scene.directional_lights = {{{-1, 0, -1}, {3, 3, 3}}};
    const glm::dvec3 textured = in_the_middle(scene);
    scene.materials[0].metallic_roughness = MetallicRoughness{{0.5F, 0.25F, 1.0F}, 0.25F, 0.5F, {}};
    expect_near(textured, in_the_middle(scene));
    scene.materials[0].metallic_roughness->roughness = 0.0F;  // No less than 0.045.
    const glm::dvec3 smooth = in_the_middle(scene);
    scene.materials[0].metallic_roughness->roughness = 0.045F;
    expect_near(smooth, in_the_middle(scene));
}

TEST(ReferenceShading, OfMetallicRoughnessInSurroundings) {
    Material material;
    material.metallic_roughness = MetallicRoughness{{0.5F, 0.25F, 1.0F}, 0.25F, 0.5F, {}};
    material.occlusion_texture = Texture{0};
    Scene scene = square(material);
    scene.images = {{"occlusion", texel({0.5F, 1, 1, 1})}};
    scene.ambient = glm::vec3(3.0F);
    scene.environment = test::constant_environment({2.0F, 2.0F, 2.0F}, false);
    scene.environment->lights = true;
    const glm::dvec3 b(0.5, 0.25, 1.0);
    const glm::dvec3 f0 = 0.75 * 0.04 + 0.25 * b;
    const glm::dvec2 albedo = reference::directional_albedo(1.0, 0.5);
    const glm::dvec3 mirrors = f0 * albedo.x + albedo.y;
    expect_near(in_the_middle(scene),
                0.5 * (3.0 * (0.75 * b + f0) + (1.0 - mirrors) * 0.75 * b * 2.0 + mirrors * 2.0));
}

TEST(ReferenceShading, OfTheEyesOppositeLampHasNoHalfVector) {
    Material material = test::black_material();
    material.specular = glm::vec3(1.0F);
    Scene scene = square(material);
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
    Scene scene = square(material);
    // A lamp above the upper right corner: only lamp and corner matter there.
    scene.point_lights = {{{2, 2, 1}, {1, 1, 1}}};
    const auto at_corner = [&](double x, double y) {
        const glm::dvec3 way(2 - x, 2 - y, 1);
        const glm::dvec3 light = glm::normalize(way);
        const glm::dvec3 view = glm::normalize(glm::dvec3(-x, -y, 3));
        const double n_dot_h = glm::normalize(light + view).z;
        return (light.z + std::pow(n_dot_h, 3.0)) / glm::dot(way, way);
    };
    // The pixel (1, 0) of 2 x 2, at (1, 1), is three quarters of the way along the edge between
    // the halves of the square, or just beside it: its diagonal goes from upper left to lower
    // right. In the triangle of the corners (-2, 2), (2, -2), (2, 2) its weights are 1/4, 1/4, 1/2.
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
    Scene scene = square(material);
    scene.meshes[0].edit().normals.assign(4, glm::vec3(0, 0, 1));
    for (glm::uvec3& triangle : scene.meshes[0].edit().triangles)
        std::swap(triangle.y, triangle.z);  // Seen from behind: the normal counts as -z.
    scene.directional_lights = {{{0, 0, -1}, {1, 1, 1}}, {{0, 3, 4}, {2, 2, 2}}};
    expect_near(in_the_middle(scene), glm::dvec3(1.6));
}

}  // namespace
}  // namespace relief
