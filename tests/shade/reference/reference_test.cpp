// SPDX-License-Identifier: Apache-2.0
// Whole pictures of the CPU reference: composition, hard inputs, determinism, and the conversion
// of radiance to codes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "relief/mesh/execution.h"
#include "relief/mesh/report.h"
#include "relief/shade/image_compare.h"
#include "relief/shade/reference.h"
#include "relief/shade/scene_fields.h"
#include "shade/reference/traced.h"
#include "shade/render/draw_support.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::shade;

namespace {

using test::pixel;

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

/// Unlit squares at z = 0, -0.5, -1, ..., the first one nearest.
Scene stacked(const std::vector<Material>& materials) {
    Scene scene = test::scene_of(test::facing_square(), Material{});
    scene.materials = materials;
    scene.meshes.clear();
    scene.instances.clear();
    for (std::uint32_t i = 0; i < materials.size(); ++i) {
        Mesh mesh = test::facing_square();
        mesh.material_ranges = {{0, 2, i}};
        scene.meshes.push_back(mesh);
        glm::mat4 place(1.0F);
        place[3].z = -0.5F * static_cast<float>(i);
        scene.instances.push_back({i, place, "layer"});
    }
    return scene;
}

Material unlit(const glm::vec3& color, AlphaMode mode = AlphaMode::opaque, float opacity = 1.0F) {
    Material material;
    material.unlit = true;
    material.diffuse = color;
    material.alpha_mode = mode;
    material.opacity = opacity;
    return material;
}

glm::dvec4 pixel_in_the_middle(const Scene& scene) {
    return pixel(test::traced(scene, 3).radiance, 1, 1);
}

TEST(Reference, ShowsTheNearestOpaqueSurface) {
    const Scene scene = stacked({unlit({1, 0, 0}), unlit({0, 1, 0})});
    EXPECT_EQ(pixel_in_the_middle(scene), glm::dvec4(1, 0, 0, 1));
    EXPECT_EQ(test::traced(scene, 3).hits[4].instance, 0U);
}

TEST(Reference, ComposesBlendedSurfacesFarthestFirst) {
    const Scene scene =
        stacked({unlit({1, 0, 0}, AlphaMode::blend, 0.5F),
                 unlit({0, 1, 0}, AlphaMode::blend, 0.25F), unlit({0, 0, 1}), unlit({9, 9, 9})});
    EXPECT_EQ(pixel_in_the_middle(scene), glm::dvec4(0.5, 0.125, 0.375, 1));
}

TEST(Reference, BlendsWithTheBackground) {
    const Scene scene = stacked(
        {unlit({1, 0, 0}, AlphaMode::blend, 0.5F), unlit({0, 1, 0}, AlphaMode::blend, 0.5F)});
    const glm::dvec4 found = pixel_in_the_middle(scene);
    EXPECT_NEAR(found.r, 2.0 / 3, 1e-7);
    EXPECT_NEAR(found.g, 1.0 / 3, 1e-7);
    EXPECT_EQ(found.a, 0.75);
}

TEST(Reference, BlendsTheEdgeBetweenTwoTrianglesOnce) {
    // The diagonal passes through the centers of 16 pixels.
    const Scene scene = stacked({unlit({1, 1, 1}, AlphaMode::blend, 0.5F)});
    const Image image = test::traced(scene, 16).radiance;
    for (int i = 0; i < 16; ++i)
        EXPECT_EQ(pixel(image, i, i).a, 0.5) << i;
}

TEST(Reference, CutsMasksAtTheirCutoff) {
    Material cut = unlit({1, 0, 0}, AlphaMode::mask, 0.5F);
    cut.alpha_cutoff = 0.5F;
    EXPECT_EQ(pixel_in_the_middle(stacked({cut, unlit({0, 1, 0})})), glm::dvec4(1, 0, 0, 1));
    cut.opacity = 0.4375F;
    EXPECT_EQ(pixel_in_the_middle(stacked({cut, unlit({0, 1, 0})})), glm::dvec4(0, 1, 0, 1));
}

TEST(Reference, AlphaIsTheProductOfAllItsSources) {
    Material material = unlit({1, 1, 1}, AlphaMode::blend, 0.5F);
    material.diffuse_texture = Texture{0};
    material.opacity_texture = Texture{1};
    Scene scene = stacked({material});
    scene.images = {{"diffuse", test::constant_image({1, 1, 1, 0.5F}, 4, 32, ColorSpace::linear)},
                    {"opacity", test::constant_image({0.75F, 0, 0, 0}, 3, 32, ColorSpace::data)}};
    scene.meshes[0].edit().colors.assign(4, {1, 1, 1, 0.5F});
    EXPECT_EQ(pixel_in_the_middle(scene), glm::dvec4(1, 1, 1, 0.5 * 0.5 * 0.75 * 0.5));
    scene.materials[0].alpha_mode = AlphaMode::opaque;
    EXPECT_EQ(pixel_in_the_middle(scene).a, 1.0);
}

TEST(Reference, DrawsBackFacesOfDoubleSidedMaterialsOnly) {
    Scene scene = stacked({unlit({1, 0, 0}), unlit({0, 1, 0})});
    for (glm::uvec3& triangle : scene.meshes[0].edit().triangles)
        std::swap(triangle.y, triangle.z);
    EXPECT_EQ(pixel_in_the_middle(scene), glm::dvec4(0, 1, 0, 1));
    scene.materials[0].double_sided = true;
    EXPECT_EQ(pixel_in_the_middle(scene), glm::dvec4(1, 0, 0, 1));
    EXPECT_TRUE(test::traced(scene, 3).hits[4].back);
}

TEST(Reference, ShowsTheSkyboxBehindEverything) {
    Scene scene = stacked({unlit({1, 0, 0}, AlphaMode::blend, 0.5F)});
    scene.environment = test::constant_environment({0.25F, 0.5F, 1.0F}, true);
    EXPECT_EQ(pixel_in_the_middle(scene), glm::dvec4(0.625, 0.25, 0.5, 1));
    scene.instances.clear();
    EXPECT_EQ(pixel_in_the_middle(scene), glm::dvec4(0.25, 0.5, 1, 1));
    scene.environment->skybox = false;
    EXPECT_EQ(pixel_in_the_middle(scene), glm::dvec4(0.0));
}

TEST(Reference, IsTheSameForAnyNumberOfThreads) {
    Material material;
    material.specular = glm::vec3(0.5F);
    material.alpha_mode = AlphaMode::blend;
    material.opacity = 0.5F;
    Scene scene = test::scene_of(test::sphere(64, 32), material);
    scene.point_lights = {{{1, 2, 3}, {4, 4, 4}}};
    set_thread_limit(1);
    const Reference one = test::traced(scene, 48);
    set_thread_limit(0);
    const Reference many = test::traced(scene, 48);
    EXPECT_TRUE(test::same_bits(one.radiance, many.radiance));
    EXPECT_TRUE(test::same_bits(one.edges, many.edges));
    EXPECT_EQ(one.hits, many.hits);
}

TEST(Reference, HoldsNoNumbersThatAreNone) {
    Scene scene = test::scene_of(test::facing_square(), Material{});
    scene.ambient = glm::vec3(1.0F);
    Mesh& mesh = scene.meshes[0].edit();
    mesh.colors.assign(4, glm::vec4(1.0F));
    mesh.colors[0] = glm::vec4(not_a_number);
    mesh.positions.emplace_back(not_a_number, 0.0F, 0.0F);
    mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
    mesh.texcoords.emplace_back(0.0F, 0.0F);
    mesh.colors.emplace_back(1.0F);
    mesh.triangles.emplace_back(0, 1, 4);
    mesh.material_ranges[0].triangle_count = 3;
    Report report;
    const Reference reference = render_reference(scene, {16, 16}, report);
    EXPECT_EQ(report.count("vertex that is not finite"), 1U);
    for (const float sample : reference.radiance.as<float>())
        EXPECT_TRUE(std::isfinite(sample) && sample >= 0.0F);
    // Corner 0, the upper left, belongs to both triangles, so the whole square is black.
    EXPECT_EQ(pixel(reference.radiance, 2, 2), glm::dvec4(0, 0, 0, 1));
}

TEST(Reference, MapsNaNToBlackAndInfinityToTheMaximum) {
    Image image = make_image(1, 1, 3, 32, ColorSpace::linear);
    image.samples = std::vector<float>{not_a_number, std::numeric_limits<float>::infinity(), -1.0F};
    Material material = unlit({1, 1, 1});
    material.diffuse_texture = Texture{0};
    // Between texels, infinity times a weight of 0 is NaN.
    material.diffuse_texture->filter = TextureFilter::nearest;
    Scene scene = stacked({material});
    scene.images = {{"texture", image}};
    const glm::dvec4 found = pixel_in_the_middle(scene);
    EXPECT_EQ(found.r, 0.0);
    EXPECT_GT(found.g, 1e38);
    EXPECT_EQ(found.b, 0.0);
}

TEST(Reference, DrawsGeometryOfSingularMatrices) {
    Scene scene = test::scene_of(test::sphere(32, 16), unlit({1, 1, 1}));
    scene.instances[0].world_from_object[2].z = 0.0F;
    EXPECT_EQ(pixel_in_the_middle(scene).a, 1.0);
    scene.instances[0].world_from_object[1].y = 0.0F;
    EXPECT_EQ(pixel_in_the_middle(scene).a, 0.0);
    scene.instances[0].world_from_object = glm::mat4(0.0F);
    EXPECT_EQ(pixel_in_the_middle(scene).a, 0.0);
}

TEST(Reference, IsInvariantToScaleAndTranslation) {
    Material material;
    material.specular = glm::vec3(0.5F);
    Scene scene = test::scene_of(test::sphere(32, 16), material);
    scene.directional_lights = {{{-1, -2, -3}, {1, 1, 1}}};
    const Image expected = test::traced(scene, 16).radiance;
    for (const float scale : {1e-12F, 1e12F}) {
        Scene scaled = scene;
        scaled.instances[0].world_from_object = glm::mat4(scale);
        scaled.instances[0].world_from_object[3] = {0, 0, 0, 1};
        scaled.camera->world_from_view[3] = {0, 0, 3.0F * scale, 1};
        scaled.camera->near *= scale;
        scaled.camera->far *= scale;
        EXPECT_LE(compare(test::traced(scaled, 16).radiance, expected).max, 1e-6) << scale;
    }
    const glm::vec3 away(1048576.0F, -2097152.0F, 524288.0F);
    scene.instances[0].world_from_object[3] = {away, 1};
    scene.camera->world_from_view[3] = {away + glm::vec3(0, 0, 3), 1};
    EXPECT_LE(compare(test::traced(scene, 16).radiance, expected).max, 1e-6);
}

TEST(Reference, LeavesOutTexturesThatCannotBeReadAndNamesThem) {
    for (const test::UnreadableTexture& texture : test::unreadable_textures()) {
        Scene equal = test::scene_for_unreadable_textures();
        texture.make_equal(equal.materials[0]);
        Scene scene = test::scene_for_unreadable_textures();
        texture.set(scene.materials[0], Texture{0});
        scene.images = {{"brick", std::filesystem::path("/nowhere/brick.png"), "wall.gltf"}};
        Report report;
        const Reference reference = render_reference(scene, {24, 24}, report);
        EXPECT_TRUE(test::same_bits(reference.radiance, test::traced(equal, 24).radiance))
            << texture.effect;
        ASSERT_EQ(report.findings().size(), 1U) << texture.effect;
        const Finding& finding = report.findings()[0];
        EXPECT_EQ(finding.kind,
                  std::string("unreadable ") + texture.effect + " of material 'wall'");
        EXPECT_THAT(finding.outcome, testing::HasSubstr("drawn without it: wall.gltf: "
                                                        "/nowhere/brick.png: no such file"));
        scene.images[0].is_required = true;
        EXPECT_THROW((void)render_reference(scene, {24, 24}, report), FileError) << texture.effect;
    }
}

TEST(Reference, RefusesInvalidScenes) {
    Scene scene = test::scene_of(test::facing_square(), Material{});
    Report report;
    EXPECT_THROW((void)render_reference(scene, {0, 8}, report), InvalidInput);
    EXPECT_THROW((void)render_reference(scene, {8, 8, -1.0}, report), InvalidInput);
    scene.materials[0].shininess = -1.0F;
    EXPECT_THROW((void)render_reference(scene, {8, 8}, report), InvalidInput);
    scene.materials[0].shininess = 1.0F;
    scene.camera.reset();
    try {
        (void)render_reference(scene, {8, 8}, report);
        FAIL() << "a scene without a camera was drawn";
    } catch (const InvalidInput& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("camera"));
    }
}

/// Returns the output of one gray pixel.
glm::dvec4 shown(float light, const Scene& scene, OutputCoding output, float alpha = 1.0F) {
    Image radiance = make_image(1, 1, 4, 32, ColorSpace::linear);
    radiance.samples = std::vector<float>{light, light, light, alpha};
    return test::pixel(reference_picture(radiance, scene, output), 0, 0);
}

/// Returns the light of an sRGB output.
double shown_light(float light, const Scene& scene, float alpha = 1.0F) {
    return static_cast<double>(
        linear_from_srgb(static_cast<float>(shown(light, scene, OutputCoding::srgb, alpha).r)));
}

TEST(ReferencePicture, IsExposedAndThenToneMapped) {
    Scene scene;
    scene.exposure = 0.5F;
    EXPECT_NEAR(shown_light(1.5F, scene), 0.75, 1e-6);
    EXPECT_NEAR(shown_light(3.0F, scene), 1.0, 1e-6);
    scene.tone_mapping = ToneMapping::reinhard;
    EXPECT_NEAR(shown_light(6.0F, scene), 0.75, 1e-6);
    scene.tone_mapping = ToneMapping::aces;
    // With x = 1: (2.51 + 0.03) / (2.43 + 0.59 + 0.14).
    EXPECT_NEAR(shown_light(2.0F, scene), 2.54 / 3.16, 1e-6);
    EXPECT_NEAR(shown_light(1e30F, scene), 1.0, 1e-6);
}

/// Returns the output of one pixel of a color, as light.
glm::dvec3 shown_color(const glm::vec3& color, ToneMapping curve) {
    Scene scene;
    scene.tone_mapping = curve;
    Image radiance = make_image(1, 1, 4, 32, ColorSpace::linear);
    radiance.samples = std::vector<float>{color.r, color.g, color.b, 1.0F};
    const glm::dvec4 coded =
        test::pixel(reference_picture(radiance, scene, OutputCoding::srgb), 0, 0);
    glm::dvec3 light(0.0);
    for (int i = 0; i < 3; ++i)
        light[i] = static_cast<double>(linear_from_srgb(static_cast<float>(coded[i])));
    return light;
}

/// The codes of middle gray, 0.18, in other viewers.
TEST(ReferencePicture, HasTheMiddleGrayOfOtherViewers) {
    Scene scene;
    const std::vector<std::pair<ToneMapping, double>> codes = {
        {ToneMapping::aces, 0.553},
        {ToneMapping::aces_hill, 0.3585},
        {ToneMapping::aces_hill_boost, 0.499},
        {ToneMapping::khronos_neutral, 0.410}};  // That of 0.18 - 0.04.
    for (const auto& [curve, code] : codes) {
        scene.tone_mapping = curve;
        EXPECT_NEAR(shown(0.18F, scene, OutputCoding::srgb).r, code, 1e-3) << enum_name(curve);
    }
}

TEST(ReferencePicture, ByKhronosNeutralKeepsColorsUpToItsStart) {
    const auto neutral = [](const glm::vec3& color) {
        return shown_color(color, ToneMapping::khronos_neutral);
    };
    // The smallest channel, 0.2, is above 0.08: all lose 0.04.
    const glm::dvec3 kept = neutral({0.7F, 0.2F, 0.4F});
    EXPECT_NEAR(kept.r, 0.66, 1e-6);
    EXPECT_NEAR(kept.g, 0.16, 1e-6);
    EXPECT_NEAR(kept.b, 0.36, 1e-6);
    // The peak 1.6 becomes 1 - 0.24^2 / (1.6 + 0.24 - 0.76), and the saturation falls.
    const glm::dvec3 bright = neutral({1.6F, 0.0F, 0.8F});
    const double peak = 1.0 - 0.0576 / 1.08;
    const double share = 1.0 / (0.15 * (1.6 - peak) + 1.0);
    EXPECT_NEAR(bright.r, peak, 1e-6);
    EXPECT_NEAR(bright.g, peak * (1.0 - share), 1e-6);
    EXPECT_NEAR(bright.b, peak * (1.0 - share) + share * 0.5 * peak, 1e-6);
}

/// By hand for pure red: ACES' own space holds (0.59719, 0.07600, 0.02840).
TEST(ReferencePicture, ByHillsFitMixesChannelsAsAcesDoes) {
    const auto fit = [](double x) {
        return (x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.432951) + 0.238081);
    };
    const glm::dvec3 v(fit(0.59719), fit(0.076), fit(0.0284));
    const glm::dvec3 red = shown_color({1.0F, 0.0F, 0.0F}, ToneMapping::aces_hill);
    EXPECT_NEAR(red.r, 1.60475 * v.r - 0.53108 * v.g - 0.07367 * v.b, 1e-6);
    EXPECT_EQ(red.g, 0.0);  // -0.10208 of red is more than the rest.
    EXPECT_NEAR(red.b, std::max(-0.00327 * v.r - 0.07276 * v.g + 1.07602 * v.b, 0.0), 1e-6);
    EXPECT_NEAR(shown_color({0.6F, 0.0F, 0.0F}, ToneMapping::aces_hill_boost).r, red.r, 1e-6);
}

TEST(ReferencePicture, LinearLightIsNeitherExposedNorToneMapped) {
    Scene scene;
    scene.exposure = 0.5F;
    scene.tone_mapping = ToneMapping::aces;
    EXPECT_EQ(shown(3.0F, scene, OutputCoding::linear).r, 3.0);
    EXPECT_EQ(shown(3.0F, scene, OutputCoding::clamped).r, 1.0);
    EXPECT_EQ(shown(0.5F, scene, OutputCoding::clamped).r, 0.5);
    EXPECT_THROW((void)shown(0.5F, scene, OutputCoding::half), InvalidInput);
}

TEST(ReferencePicture, IsCodedByTheStandardsCurve) {
    const Scene scene;
    EXPECT_NEAR(shown(0.5F, scene, OutputCoding::srgb).r, 0.7353569830, 1e-7);
    EXPECT_NEAR(shown(0.001F, scene, OutputCoding::srgb).r, 0.01292, 1e-9);
    EXPECT_EQ(shown(1.0F, scene, OutputCoding::srgb), glm::dvec4(1.0));
}

TEST(ReferencePicture, BackgroundIsNeitherExposedNorToneMapped) {
    Scene scene;
    scene.exposure = 2.0F;
    scene.tone_mapping = ToneMapping::reinhard;
    scene.background = {0.25F, 0.25F, 0.25F, 1.0F};
    EXPECT_NEAR(shown_light(0.0F, scene, 0.0F), 0.25, 1e-6);
    // A surface of radiance 1.5 with a coverage of one half; the curve maps it to 0.75.
    EXPECT_NEAR(shown_light(1.5F, scene, 0.5F), 0.5, 1e-6);
    // Over a half-opaque background: (0.75 * 0.5 + 0.25 * 0.25) / 0.75, and alpha 0.75.
    scene.background.a = 0.5F;
    EXPECT_NEAR(shown_light(1.5F, scene, 0.5F), 0.4375 / 0.75, 1e-6);
    EXPECT_NEAR(shown(1.5F, scene, OutputCoding::srgb, 0.5F).a, 0.75, 1e-7);
}

TEST(ReferencePicture, HasNoNaN) {
    Scene scene;
    for (const auto& [name, mapping, label] : enum_names<ToneMapping>) {
        SCOPED_TRACE(name);
        scene.tone_mapping = mapping;
        EXPECT_EQ(shown(std::numeric_limits<float>::quiet_NaN(), scene, OutputCoding::srgb).r, 0.0);
        EXPECT_EQ(shown(-1.0F, scene, OutputCoding::srgb).r, 0.0);
        EXPECT_NEAR(shown(std::numeric_limits<float>::infinity(), scene, OutputCoding::srgb).r, 1.0,
                    1e-6);
    }
}

}  // namespace
}  // namespace relief
