// SPDX-License-Identifier: Apache-2.0
// The shading normal: interpolated, flat, mapped, bumped, on both sides and under every matrix. It
// is read off the light of three lamps that shine along the axes.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/angle.h"
#include "support/shapes.h"
#include "traced.h"

namespace relief {
namespace {

using test::storage_rounding;

/// A white surface under red, green and blue light from +x, +y and +z: its radiance is its normal,
/// where that is not negative.
Scene measured(Mesh mesh, Material material = {}) {
    material.ambient = glm::vec3(0.0F);
    material.diffuse = glm::vec3(1.0F);
    Scene scene = test::scene_of(std::move(mesh), material);
    scene.directional_lights = {
        {{-1, 0, 0}, {1, 0, 0}}, {{0, -1, 0}, {0, 1, 0}}, {{0, 0, -1}, {0, 0, 1}}};
    return scene;
}

/// The normal at a pixel, both signs: the lamps turned round show the rest.
glm::dvec3 normal_at(Scene scene, int size, int x, int y) {
    const glm::dvec3 positive = test::radiance_at(scene, size, x, y);
    for (DirectionalLight& lamp : scene.directional_lights)
        lamp.direction_world = -lamp.direction_world;
    return positive - test::radiance_at(scene, size, x, y);
}

void expect_normal(const Scene& scene, const glm::dvec3& expected) {
    const glm::dvec3 found = normal_at(scene, 3, 1, 1);
    const glm::dvec3 unit = glm::normalize(expected);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(found[i], unit[i], storage_rounding) << i;
}

TEST(ReferenceSurface, InterpolatesNormalsAndMakesThemUnit) {
    Mesh mesh = test::facing_square();
    for (std::size_t i = 0; i < 4; ++i)
        mesh.normals[i] = mesh.positions[i].x < 0 ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0);
    // At (1, 1, 0): a quarter to three quarters.
    const glm::dvec3 found = normal_at(measured(mesh), 2, 1, 0);
    const glm::dvec3 expected = glm::normalize(glm::dvec3(0.75, 0, 0.25));
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(found[i], expected[i], storage_rounding);
}

TEST(ReferenceSurface, InterpolatesWithPerspective) {
    // Tilted about y: the left edge at depth 2, the right one at depth 4, 4 wide in x.
    Mesh mesh = test::facing_square();
    for (std::size_t i = 0; i < 4; ++i) {
        mesh.positions[i].z = mesh.positions[i].x < 0 ? 1.0F : -1.0F;
        mesh.colors.emplace_back(mesh.positions[i].x < 0 ? 0.0F : 1.0F, 0.0F, 0.0F, 1.0F);
    }
    Material material = test::black_material();
    material.unlit = true;
    material.diffuse = glm::vec3(1.0F);
    Scene scene = test::scene_of(mesh, material);
    // The middle ray meets x = 0, half-way in space; on screen the edges are at -3 and 1.5.
    EXPECT_NEAR(test::radiance_at(scene, 3, 1, 1).r, 0.5, storage_rounding);
    // The pixel of 4 at x = 1/3 of depth... by similar triangles: x = 0.5 z / 1.5.. solved: 3/7.
    const double slope = (-2.0 + 4.0 * 2.5 / 4.0) / 3.0;  // x over depth.
    const double x = 3.0 * slope / (1.0 - slope * 0.5);   // depth = 3 + x / 2.
    EXPECT_NEAR(test::radiance_at(scene, 4, 2, 1).r, (x + 2.0) / 4.0, storage_rounding);
}

TEST(ReferenceSurface, FlatUsesThePlaneAndFacesTheViewer) {
    Mesh mesh = test::facing_square();
    mesh.normals.assign(4, glm::vec3(1, 0, 0));
    for (glm::vec3& position : mesh.positions)
        position.z = 0.5F * position.x;
    Material material;
    material.interpolation = Interpolation::flat;
    expect_normal(measured(mesh, material), {-0.5, 0, 1});
    material.double_sided = true;
    for (glm::uvec3& triangle : mesh.triangles)
        std::swap(triangle.y, triangle.z);
    expect_normal(measured(mesh, material), {-0.5, 0, 1});
    Scene mirrored = measured(mesh, material);
    mirrored.instances[0].world_from_object[0].x = -1.0F;
    expect_normal(mirrored, {0.5, 0, 1});
}

TEST(ReferenceSurface, TurnsNormalsOfBackFacesRound) {
    Mesh mesh = test::facing_square();
    mesh.normals.assign(4, glm::normalize(glm::vec3(0.5F, 0.25F, 1.0F)));
    Material material;
    material.double_sided = true;
    for (glm::uvec3& triangle : mesh.triangles)
        std::swap(triangle.y, triangle.z);
    expect_normal(measured(mesh, material), {-0.5, -0.25, -1});
    material.double_sided = false;
    EXPECT_EQ(test::traced(measured(mesh, material), 3).hits[4], ReferenceHit{});
}

TEST(ReferenceSurface, BringsNormalsToTheWorldByCofactors) {
    Mesh mesh = test::facing_square();
    mesh.normals.assign(4, glm::normalize(glm::vec3(0.5F, 0.25F, 1.0F)));
    Scene scene = measured(mesh);
    glm::mat4& place = scene.instances[0].world_from_object;
    place = glm::mat4(2.0F);
    place[0].x = 4.0F;
    place[3] = {0, 0, 0, 1};
    expect_normal(scene, {0.125, 0.125, 0.5});
    place[0].x = -4.0F;  // Mirrored: x turned round, front still front.
    expect_normal(scene, {-0.125, 0.125, 0.5});
    place[0].x = 4.0F;
    place[2].z = 0.0F;  // Flattened onto its own plane.
    expect_normal(scene, {0, 0, 1});
}

TEST(ReferenceSurface, WithoutDirectionIsTheZAxis) {
    const float infinite = std::numeric_limits<float>::infinity();
    for (const glm::vec3& bad : {glm::vec3(0.0F), glm::vec3(NAN), glm::vec3(infinite)}) {
        Mesh mesh = test::facing_square();
        mesh.normals.assign(4, bad);
        expect_normal(measured(mesh), {0, 0, 1});
    }
}

/// A one-texel map of codes, under FlatCode::middle.
Scene mapped(Mesh mesh, int x, int y, int z, Material material = {}) {
    if (!material.normal_map) material.normal_map = NormalMap{Texture{0}};
    material.normal_map->flat = FlatCode::middle;
    Scene scene = measured(std::move(mesh), material);
    Image map = make_image(1, 1, 3, 8, ColorSpace::data);
    map.samples = std::vector<std::uint8_t>{static_cast<std::uint8_t>(128 + x),
                                            static_cast<std::uint8_t>(128 + y),
                                            static_cast<std::uint8_t>(128 + z)};
    scene.images = {{"map", map}};
    return scene;
}

TEST(ReferenceSurface, LeansByItsNormalMapsCodes) {
    expect_normal(mapped(test::facing_square(), 60, -30, 112), {60, -30, 112});
    Material material;
    material.normal_map = NormalMap{Texture{0}, 0.5F, Green::down};
    expect_normal(mapped(test::facing_square(), 60, -30, 112, material), {30, 15, 112});
    Scene halves = mapped(test::facing_square(), 60, -30, 112);
    halves.materials[0].normal_map->flat = FlatCode::half;
    expect_normal(halves, {60.5, -29.5, 112.5});
    // Sixteen bits: the middle is 32768.
    Image fine = make_image(1, 1, 3, 16, ColorSpace::data);
    fine.samples = std::vector<std::uint16_t>{32768 + 6000, 32768 - 3000, 32768 + 20000};
    Scene sixteen = mapped(test::facing_square(), 0, 0, 0);
    sixteen.images[0].source = fine;
    expect_normal(sixteen, {6, -3, 20});
}

TEST(ReferenceSurface, WithNothingInItsMapIsTheInterpolatedNormal) {
    Mesh mesh = test::facing_square();
    mesh.normals.assign(4, glm::normalize(glm::vec3(0.5F, 0.25F, 1.0F)));
    expect_normal(mapped(mesh, 0, 0, 0), {0.5, 0.25, 1});
}

TEST(ReferenceSurface, UsesTheStoredBasisAsInterpolated) {
    Mesh mesh = test::facing_square();
    mesh.tangents.assign(4, glm::vec4(1, 0, 0, 1));
    // Normals lean apart: at the origin, half-way, (0, 0, cos 0.9) is left, and the bitangent w
    // cross(n, t) is as short.
    for (std::size_t i = 0; i < 4; ++i) {
        const float side = mesh.positions[i].y > 0 ? 1.0F : -1.0F;
        mesh.normals[i] = {0, side * std::sin(0.9F), std::cos(0.9F)};
    }
    const double left = static_cast<double>(std::cos(0.9F));
    expect_normal(mapped(mesh, 60, 40, 112), {60, 40 * left, 112 * left});
    for (glm::vec4& tangent : mesh.tangents)
        tangent.w = -1.0F;
    expect_normal(mapped(mesh, 60, 40, 112), {60, -40 * left, 112 * left});
}

TEST(ReferenceSurface, MirroredLeansWithItsTexture) {
    Scene scene = mapped(test::facing_square(), 60, 40, 112);
    scene.instances[0].world_from_object[0].x = -1.0F;
    expect_normal(scene, {-60, 40, 112});
}

TEST(ReferenceSurface, DerivedFramesAgreeWithStoredOnesOnAPlane) {
    for (const bool mirrored_texture : {false, true}) {
        for (const bool mirrored_place : {false, true}) {
            SCOPED_TRACE(testing::Message() << mirrored_texture << mirrored_place);
            Mesh mesh = test::facing_square();
            // A texture that is turned and sheared: u along (2, 1), v along (-1, 3).
            for (std::size_t i = 0; i < 4; ++i) {
                const glm::vec3& p = mesh.positions[i];
                mesh.texcoords[i] = {2.0F * p.x + p.y, -p.x + 3.0F * p.y};
                if (mirrored_texture) mesh.texcoords[i].y *= -1.0F;
            }
            Material material;
            material.normal_map = NormalMap{Texture{0}};
            material.tangent_frame = TangentFrame::derivatives;
            Scene scene = mapped(mesh, 60, 40, 112, material);
            if (mirrored_place) scene.instances[0].world_from_object[0].x = -1.0F;
            // dP/du is along (3, 1), where v does not change; v grows upwards unless mirrored.
            const double up = mirrored_texture ? 1.0 : -1.0;
            const glm::dvec3 tangent = glm::normalize(glm::dvec3(3, 1, 0));
            const glm::dvec3 bitangent = up * glm::dvec3(-tangent.y, tangent.x, 0);
            glm::dvec3 expected = 60.0 * tangent + 40.0 * bitangent + glm::dvec3(0, 0, 112);
            if (mirrored_place) expected.x = -expected.x;
            expect_normal(scene, expected);
        }
    }
}

TEST(ReferenceSurface, WithoutATextureGradientIsTheInterpolatedNormal) {
    Mesh mesh = test::facing_square();
    mesh.texcoords.assign(4, glm::vec2(0.25F));
    Material material;
    material.normal_map = NormalMap{Texture{0}};
    material.tangent_frame = TangentFrame::derivatives;
    // The map leans, but there is no way to lean to: only its z is left.
    expect_normal(mapped(mesh, 60, 40, 112, material), {0, 0, 1});
}

TEST(ReferenceSurface, ReadsObjectSpaceMapsThroughTheMatrix) {
    Material material;
    material.normal_map = NormalMap{Texture{0}, 1.0F, Green::up, std::nullopt, NormalSpace::object};
    Scene scene = mapped(test::facing_square(), 60, -30, 112, material);
    expect_normal(scene, {60, -30, 112});
    scene.instances[0].world_from_object[0].x = -2.0F;
    expect_normal(scene, {-30, -30, 112});
    scene.materials[0].normal_map->green = Green::down;
    expect_normal(scene, {-30, 30, 112});
}

/// A bump map whose heights rise by one step a texel, over 64 texels a side.
Scene bumped(float right, float down, float strength) {
    Material material;
    material.bump_map = BumpMap{Texture{0, TextureWrap::clamp, TextureWrap::clamp}, strength};
    Scene scene = measured(test::facing_square(), material);
    Image heights = make_image(64, 64, 1, 32, ColorSpace::data);
    auto samples = heights.as<float>();
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = right * static_cast<float>(i % 64) + down * static_cast<float>(i / 64);
    scene.images = {{"heights", heights}};
    return scene;
}

TEST(ReferenceSurface, LeansAwayFromWhereItsBumpsRise) {
    expect_normal(bumped(0.25F, 0, 2.0F), {-0.5, 0, 1});
    // Rising downwards in the image is falling upwards: the normal leans up.
    expect_normal(bumped(0, 0.25F, 2.0F), {0, 0.5, 1});
    expect_normal(bumped(0.125F, -0.25F, -2.0F), {0.25, 0.5, 1});
}

TEST(ReferenceSurface, IsAsInterpolatedWhereAMeshHasNoTexcoords) {
    Scene scene = bumped(0.25F, 0, 2.0F);
    scene.meshes[0].edit().texcoords.clear();
    expect_normal(scene, {0, 0, 1});
}

}  // namespace
}  // namespace relief
