// SPDX-License-Identifier: Apache-2.0
// Normal maps in the renderer: flat ones change nothing, codes and directions mean what
// normal_map.h says, and the basis is the one that bakers assume.
#include <gtest/gtest.h>

#include <cmath>

#include "draw_test.h"
#include "relief/shade/image_compare.h"
#include "support/shapes.h"

namespace relief {
namespace {

using test::pixel;

class NormalMapping : public test::DrawTest {};

Scene mapped(Mesh mesh, const Image& map, Green green, std::optional<FlatCode> flat) {
    Material material;
    material.normal_map = NormalMap{Texture{0}, 1.0F, green, flat};
    Scene scene = test::scene_of(std::move(mesh), material);
    scene.images = {{"map", map}};
    return scene;
}

TEST_F(NormalMapping, WithAFlatMapChangesNothing) {
    for (const int bits : {8, 16}) {
        SCOPED_TRACE(bits);
        Image flat = test::constant_image({0, 0, 1, 1}, 3, bits, ColorSpace::data);
        std::visit(
            [&](auto& samples) {
                for (std::size_t i = 0; i < samples.size(); ++i) {
                    using Sample = typename std::decay_t<decltype(samples)>::value_type;
                    if (i % 3 < 2) samples[i] = static_cast<Sample>(bits == 8 ? 128 : 32768);
                }
            },
            flat.samples);
        Scene scene = mapped(test::sphere(48, 24), flat, Green::up, FlatCode::middle);
        scene.directional_lights = {{{1, -1, -2}, {0.9F, 0.9F, 0.9F}}};
        const Image bent = radiance(scene, 64, 64);
        scene.materials[0].normal_map.reset();
        // The code of zero is a float's rounding away from zero: some 1e-7.
        EXPECT_LE(compare(bent, radiance(scene, 64, 64)).max, 1e-6);
    }
}

/// A map that leans by `x` and `y` in codes off the middle.
Image leaning(int x, int y, int z) {
    Image map = make_image(1, 1, 3, 8, ColorSpace::data);
    map.samples = std::vector<std::uint8_t>{static_cast<std::uint8_t>(128 + x),
                                            static_cast<std::uint8_t>(128 + y),
                                            static_cast<std::uint8_t>(128 + z)};
    return map;
}

TEST_F(NormalMapping, LeansTheWayTheMapSays) {
    const double lean = std::atan2(60.0, 112.0);
    const auto lit = [&](const Image& map, Green green, const glm::vec3& to_light) {
        Scene scene = mapped(test::facing_square(), map, green, FlatCode::middle);
        scene.materials[0].diffuse = glm::vec3(1.0F);
        scene.directional_lights = {{-to_light, {1, 1, 1}}};
        return pixel(radiance(scene, 8, 8), 4, 4).r;
    };
    const glm::vec3 right(1, 0, 0);
    const glm::vec3 up(0, 1, 0);
    constexpr double rounding = 1e-5;
    EXPECT_NEAR(lit(leaning(60, 0, 112), Green::up, right), std::sin(lean), rounding);
    EXPECT_NEAR(lit(leaning(-60, 0, 112), Green::up, right), 0.0, rounding);
    EXPECT_NEAR(lit(leaning(0, 60, 112), Green::up, up), std::sin(lean), rounding);
    EXPECT_NEAR(lit(leaning(0, 60, 112), Green::down, up), 0.0, rounding);
    EXPECT_NEAR(lit(leaning(0, -60, 112), Green::down, up), std::sin(lean), rounding);
}

TEST_F(NormalMapping, ReadsBothFlatCodes) {
    const auto lit = [&](const Image& map, FlatCode flat) {
        Scene scene = mapped(test::facing_square(), map, Green::up, flat);
        scene.materials[0].diffuse = glm::vec3(1.0F);
        scene.directional_lights = {{{-1, 0, 0}, {1, 1, 1}}};
        return pixel(radiance(scene, 8, 8), 4, 4).r;
    };
    const Image map =
        test::constant_image({192.0F / 255, 128.0F / 255, 1, 1}, 3, 8, ColorSpace::data);
    const auto sine = [](double x, double y, double z) {
        return x / std::sqrt(x * x + y * y + z * z);
    };
    EXPECT_NEAR(lit(map, FlatCode::middle), sine(64.0 / 127, 0, 1), 1e-5);
    EXPECT_NEAR(lit(map, FlatCode::half), sine(2 * 192.0 / 255 - 1, 2 * 128.0 / 255 - 1, 1), 1e-5);
}

TEST_F(NormalMapping, ScalesTheLean) {
    Scene scene = mapped(test::facing_square(), leaning(60, 0, 112), Green::up, FlatCode::middle);
    scene.materials[0].diffuse = glm::vec3(1.0F);
    scene.materials[0].normal_map->scale = 0.5F;
    scene.directional_lights = {{{-1, 0, 0}, {1, 1, 1}}};
    EXPECT_NEAR(pixel(radiance(scene, 8, 8), 4, 4).r, std::sin(std::atan2(30.0, 112.0)), 1e-5);
}

TEST_F(NormalMapping, UsesTheInterpolatedBasisAsItComes) {
    // Vertex normals lean apart, so that the interpolated one is short in the middle. There the
    // bitangent is short with it, and the tangent, the same everywhere, is not: a lean along x
    // weighs more than a renormalised basis would give it.
    Mesh mesh = test::facing_square();
    const float angle = 0.9F;
    mesh.tangents.assign(4, glm::vec4(1, 0, 0, 1));
    for (std::size_t i = 0; i < 4; ++i) {
        const float side = mesh.positions[i].y > 0 ? 1.0F : -1.0F;
        mesh.normals[i] = glm::vec3(0, side * std::sin(angle), std::cos(angle));
    }
    Scene scene = mapped(mesh, leaning(60, 0, 112), Green::up, FlatCode::middle);
    scene.materials[0].diffuse = glm::vec3(1.0F);
    scene.directional_lights = {{{-1, 0, 0}, {1, 1, 1}}};
    // An odd height puts a row of pixels on y = 0, where the normal is (0, 0, cos angle).
    const double found = pixel(radiance(scene, 9, 9), 4, 4).r;
    const double short_normal = std::cos(static_cast<double>(angle));
    EXPECT_NEAR(found, std::sin(std::atan2(60.0, 112.0 * short_normal)), 1e-4);
    EXPECT_GT(found, std::sin(std::atan2(60.0, 112.0)) + 0.1);
}

TEST_F(NormalMapping, TurnsTheBentNormalRoundOnBackFaces) {
    Scene scene = mapped(test::facing_square(), leaning(60, 0, 112), Green::up, FlatCode::middle);
    scene.materials[0].diffuse = glm::vec3(1.0F);
    scene.materials[0].double_sided = true;
    scene.instances[0].world_from_object[0].x =
        -1.0F;  // Turned about y: texture right is world left.
    scene.instances[0].world_from_object[2].z = -1.0F;
    scene.directional_lights = {{{-1, 0, 0}, {1, 1, 1}}};
    // In front the normal leans to world -x and away; its opposite leans to +x, to the light.
    EXPECT_NEAR(pixel(radiance(scene, 8, 8), 4, 4).r, std::sin(std::atan2(60.0, 112.0)), 1e-5);
}

TEST_F(NormalMapping, WithNothingInATexelUsesTheSurface) {
    Scene scene = mapped(test::facing_square(), leaning(0, 0, 0), Green::up, FlatCode::middle);
    scene.materials[0].diffuse = glm::vec3(1.0F);
    scene.directional_lights = {{{0, 0, -1}, {1, 1, 1}}};
    EXPECT_NEAR(pixel(radiance(scene, 8, 8), 4, 4).r, 1.0, 1e-6);
}

/// Normals that lean by an angle to the left and to the right, texel by texel, as floats.
Image rippled(float angle) {
    Image map = make_image(64, 64, 3, 32, ColorSpace::data);
    auto& samples = std::get<std::vector<float>>(map.samples);
    for (std::size_t i = 0; i < samples.size(); i += 3) {
        const float lean = i / 3 % 2 == 0 ? angle : -angle;
        samples[i] = 0.5F + 0.5F * std::sin(lean);
        samples[i + 1] = 0.5F;
        samples[i + 2] = 0.5F + 0.5F * std::cos(lean);
    }
    return map;
}

TEST_F(NormalMapping, WidensTheHighlightsOfRipplesFinerThanAPixel) {
    Scene scene = mapped(test::facing_square(), rippled(0.3F), Green::up, FlatCode::half);
    for (glm::vec2& texcoord : scene.meshes[0].edit().texcoords)
        texcoord *= 64.0F;  // 240 texels a pixel: only the smallest mip level is seen.
    Material& material = scene.materials[0];
    material.diffuse = glm::vec3(0.0F);
    material.specular = glm::vec3(1.0F);
    material.shininess = 100.0F;
    scene.directional_lights = {{{0, 0, -1}, glm::vec3(1.0F)}};
    const auto middle = [&] { return pixel(radiance(scene, 17, 17), 8, 8).r; };
    EXPECT_NEAR(middle(), 1.0, 1e-4);  // As if it were smooth.
    material.specular_antialiasing = true;
    const double variance = 1.0 / std::cos(0.3) - 1.0;
    const double widened = 100.0 / (1.0 + 100.0 * variance);
    EXPECT_NEAR(middle(), (1.0 + widened) / 101.0, 1e-3);
    scene.materials[0].normal_map->scale = 0.5F;  // Says nothing about what the map holds.
    EXPECT_NEAR(middle(), (1.0 + widened) / 101.0, 1e-3);

    material.metallic_roughness = MetallicRoughness{};
    material.metallic_roughness->roughness = 0.2F;
    const double sharp = 2.0 / std::pow(0.2, 4.0) - 2.0;
    const double alpha_squared = 2.0 / (sharp / (1.0 + sharp * variance) + 2.0);
    // pi D V at n = h = l = v: 1 / (4 alpha^2).
    EXPECT_NEAR(middle(), 0.25 / alpha_squared, 0.01);
}

TEST_F(NormalMapping, LeavesHighlightsAsTheyAreWhereTheMapIsNotMinified) {
    Scene scene = mapped(test::facing_square(), leaning(0, 0, 127), Green::up, FlatCode::middle);
    scene.materials[0].specular = glm::vec3(0.5F);
    scene.materials[0].shininess = 1000.0F;
    scene.directional_lights = {{{0.1F, 0, -1}, glm::vec3(1.0F)}};
    const Image sharp = radiance(scene, 32, 32);
    scene.materials[0].specular_antialiasing = true;
    // The rounding of 8-bit codes is no variance: not a bit differs.
    EXPECT_TRUE(test::same_bits(radiance(scene, 32, 32), sharp));
}

}  // namespace
}  // namespace relief
