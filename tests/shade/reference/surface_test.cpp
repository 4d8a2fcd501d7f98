// SPDX-License-Identifier: Apache-2.0
// Visible surfaces of the CPU reference: intersections of rays with triangles, edges in the
// picture, and shading normals, which the test reads from the light of three lights along the
// axes.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <vector>

#include "reference/reference_parts.h"
#include "relief/mesh/report.h"
#include "relief/shade/reference.h"
#include "shade/reference/traced.h"
#include "support/invariants.h"
#include "support/shapes.h"

namespace relief::shade::reference {
namespace {

/// A mesh at a position in view space.
struct Placed {
    std::vector<glm::dvec3> positions;
    std::vector<glm::uvec3> triangles;

    [[nodiscard]] ViewMesh view() const { return {positions, triangles}; }
};

Placed placed(const Mesh& mesh, const glm::dvec3& at, double scale = 1.0) {
    Placed result;
    for (const glm::vec3& position : mesh.positions)
        result.positions.push_back((glm::dvec3(position) + at) * scale);
    result.triangles = mesh.triangles;
    return result;
}

/// A grid of 4 x 4 cells with vertices, edges and diagonals on rays of simple numbers.
Placed wall() {
    return placed(test::grid(4), {-0.5, -0.5, -1.0});
}

Camera depth_range(float near, float far) {
    Camera camera;
    camera.near = near;
    camera.far = far;
    return camera;
}

TEST(Visibility, MeetsSharedEdgesAndVerticesOnceInside) {
    const Placed mesh = wall();
    const Visibility visibility({mesh.view()}, depth_range(0.1F, 10.0F));
    for (int y = -30; y <= 30; ++y) {
        for (int x = -30; x <= 30; ++x) {
            const auto hits = visibility.hits(x / 64.0, y / 64.0);
            // Six triangles meet at a vertex. Two of them that share no edge may both count.
            const bool at_vertex = x % 16 == 0 && y % 16 == 0;
            EXPECT_GE(hits.size(), 1U) << x << ", " << y;
            EXPECT_LE(hits.size(), at_vertex ? 3U : 1U) << x << ", " << y;
        }
    }
    EXPECT_TRUE(visibility.hits(0.51, 0.0).empty());
}

TEST(Visibility, LocatesTheIntersection) {
    Placed mesh;
    mesh.positions = {{-1, -1, -2}, {3, -1, -4}, {-1, 3, -2}};
    mesh.triangles = {{0, 1, 2}};
    const Visibility visibility({mesh.view()}, depth_range(0.1F, 10.0F));
    // The point (0.5, 0, -2.75) has the weights 3/8, 3/8, 1/4.
    const auto hits = visibility.hits(0.5 / 2.75, 0.0);
    ASSERT_EQ(hits.size(), 1U);
    EXPECT_NEAR(hits[0].barycentric.x, 0.375, 1e-14);
    EXPECT_NEAR(hits[0].barycentric.y, 0.375, 1e-14);
    EXPECT_NEAR(hits[0].barycentric.z, 0.25, 1e-14);
    EXPECT_NEAR(hits[0].depth, 2.75, 1e-14);
    EXPECT_TRUE(hits[0].counter_clockwise);
}

TEST(Visibility, FindsEveryHitNearestFirst) {
    const Placed back = placed(test::grid(1), {-0.5, -0.5, -3.0});
    const Placed front = placed(test::grid(1), {-0.5, -0.5, -2.0});
    const Placed ball = placed(test::sphere(24, 12), {0.0, 0.0, -5.0});
    const Visibility visibility({back.view(), front.view(), ball.view()}, depth_range(0.1F, 10.0F));
    const auto hits = visibility.hits(0.01, 0.02);
    ASSERT_EQ(hits.size(), 4U);
    EXPECT_EQ(hits[0].instance, 1U);
    EXPECT_EQ(hits[1].instance, 0U);
    EXPECT_EQ(hits[2].instance, 2U);
    EXPECT_TRUE(hits[2].counter_clockwise);
    EXPECT_EQ(hits[3].instance, 2U);
    EXPECT_FALSE(hits[3].counter_clockwise) << "the far side, from within";
}

TEST(Visibility, OrthographicRaysAreParallel) {
    Placed mesh;
    mesh.positions = {{-1, -1, -2}, {3, -1, -4}, {-1, 3, -2}};
    mesh.triangles = {{0, 1, 2}};
    Camera camera = depth_range(0.1F, 10.0F);
    camera.orthographic_height = 8.0F;
    const Visibility visibility({mesh.view()}, camera);
    for (const double x : {-0.9, 0.5, 1.9}) {
        const auto hits = visibility.hits(x, 0.0);
        ASSERT_EQ(hits.size(), 1U) << x;
        // The plane's depth grows by 2 over the 4 units of x.
        EXPECT_NEAR(hits[0].depth, 2.0 + 0.5 * (x + 1.0), 1e-14);
    }
    EXPECT_TRUE(visibility.hits(2.1, 0.0).empty());
}

TEST(Visibility, EndsAtTheCamerasNearAndFar) {
    const Placed mesh = wall();  // The wall is at depth 1.
    EXPECT_EQ(Visibility({mesh.view()}, depth_range(1.0F, 10.0F)).hits(0.01, 0.02).size(), 1U);
    EXPECT_EQ(Visibility({mesh.view()}, depth_range(1.0000001F, 10.0F)).hits(0.01, 0.02).size(),
              0U);
    EXPECT_EQ(Visibility({mesh.view()}, depth_range(0.1F, 1.0F)).hits(0.01, 0.02).size(), 1U);
    EXPECT_EQ(Visibility({mesh.view()}, depth_range(0.1F, 0.9999999F)).hits(0.01, 0.02).size(), 0U);
}

TEST(Visibility, DoesNotDependOnScale) {
    for (const double scale : {1e-30, 1e-12, 1e12, 1e30}) {
        SCOPED_TRACE(scale);
        const Placed ball = placed(test::sphere(24, 12), {0.0, 0.0, -5.0}, scale);
        const Visibility visibility({ball.view()}, depth_range(static_cast<float>(0.1 * scale),
                                                               static_cast<float>(10.0 * scale)));
        const auto hits = visibility.hits(0.03, -0.05);
        ASSERT_EQ(hits.size(), 2U);
        // The ray hits the exact sphere at 4.0279. Its facets lie up to a hundredth inside.
        EXPECT_NEAR(hits[0].depth / scale, 4.0279, 0.02);
    }
}

TEST(Visibility, HasNoHolesInAFineMesh) {
    // With 131,072 triangles, edges are everywhere, and Embree's floats differ from exact values.
    const Placed ball = placed(test::sphere(256, 256), {0.0, 0.0, -3.0});
    const Visibility visibility({ball.view()}, depth_range(0.1F, 10.0F));
    std::size_t odd = 0;
    for (int y = 0; y < 200; ++y) {
        for (int x = 0; x < 200; ++x) {
            const auto hits = visibility.hits((x - 99.5) / 400.0, (y - 99.5) / 400.0);
            if (hits.size() != 2U) ++odd;
        }
    }
    EXPECT_EQ(odd, 0U) << "every ray goes in once and comes out once";
}

TEST(Visibility, IgnoresDegenerateTriangles) {
    Placed mesh;
    mesh.positions = {{-1, -1, -2}, {1, 1, -2}, {0, 0, -2}, {1, 0, -2}};
    mesh.positions.emplace_back(std::numeric_limits<double>::quiet_NaN(), 0, -2);
    mesh.positions.emplace_back(std::numeric_limits<double>::infinity(), 0, -2);
    mesh.triangles = {{0, 1, 2}, {0, 0, 0}, {0, 1, 4}, {0, 1, 5}};
    const Camera camera = depth_range(0.1F, 10.0F);
    EXPECT_TRUE(Visibility({mesh.view()}, camera).hits(0.01, 0.01).empty());
    EXPECT_TRUE(Visibility({}, camera).hits(0.0, 0.0).empty());
}

/// A ball in a hollow ball with the same center.
Scene nested_balls() {
    Scene scene;
    scene.meshes = {test::sphere(16, 8)};
    scene.materials.resize(2);
    scene.meshes[0].edit().material_ranges = {
        {0, static_cast<std::uint32_t>(scene.meshes[0]->triangles.size()), 0}};
    scene.meshes.push_back(scene.meshes[0]);
    scene.meshes[1].edit().material_ranges[0].material = 1;
    scene.instances = {{0, glm::mat4(1.0F), "inner"}, {1, glm::mat4(1.0F), "outer"}};
    scene.instances[1].world_from_object = glm::scale(glm::mat4(1.0F), glm::vec3(2.0F));
    scene.ambient_occlusion = AmbientOcclusion{1.0F};
    return scene;
}

TEST(AmbientOcclusion, IsBySurfacesThatCastShadowsWithinItsDistance) {
    Scene scene = nested_balls();
    add_ambient_occlusion(scene, 8);
    EXPECT_EQ(*scene.instances[0].open_shares,
              std::vector<float>(scene.meshes[0]->positions.size(), 0.0F));
    EXPECT_TRUE(scene.instances[1].open_shares->empty()) << "all light arrives";

    scene.ambient_occlusion->distance = 0.2F;  // 0.8, which is less than the gap of 1.
    add_ambient_occlusion(scene, 8);
    EXPECT_TRUE(scene.instances[0].open_shares->empty());

    scene.ambient_occlusion->distance = 1.0F;
    scene.materials[1].alpha_mode = AlphaMode::blend;
    add_ambient_occlusion(scene, 8);
    EXPECT_TRUE(scene.instances[0].open_shares->empty());
}

TEST(AmbientOcclusion, IsNotComputedWithoutARequest) {
    Scene scene = nested_balls();
    scene.ambient_occlusion.reset();
    add_ambient_occlusion(scene, 8);
    EXPECT_TRUE(scene.instances[0].open_shares->empty());
    scene.ambient_occlusion = AmbientOcclusion{};
    EXPECT_THROW(add_ambient_occlusion(scene, 0), InvalidInput);
    scene.instances[0].open_shares = std::vector{1.0F};
    EXPECT_THROW(validate(scene), InvalidInput);
}

TEST(AmbientOcclusion, FollowsMirroredInstances) {
    Scene scene = nested_balls();
    scene.instances[1].world_from_object[0] *= -1.0F;
    scene.instances[0].world_from_object[2] *= -1.0F;
    add_ambient_occlusion(scene, 8);
    EXPECT_EQ(*scene.instances[0].open_shares,
              std::vector<float>(scene.meshes[0]->positions.size(), 0.0F));
    EXPECT_TRUE(scene.instances[1].open_shares->empty());
}

}  // namespace
}  // namespace relief::shade::reference

namespace relief {
using namespace relief::shade;

namespace {

using test::pixel;

std::size_t edge_count(const Scene& scene, int size) {
    const Reference reference = test::traced(scene, size);
    std::size_t count = 0;
    for (const std::uint8_t edge : reference.edges.as<std::uint8_t>())
        count += edge != 0 ? 1U : 0U;
    return count;
}

TEST(ReferenceEdges, AreNotWithinASmoothSurface) {
    // The square fills the picture, and its diagonal passes through pixels.
    EXPECT_EQ(edge_count(test::scene_of(test::facing_square(), Material{}), 16), 0U);
}

TEST(ReferenceEdges, AreAtSilhouettesOnly) {
    // 16 pixels cover 4 units: centers lie at 0.125, 0.375, ..., 1.125.
    const auto edges_of_a_square = [](float half_side) {
        Scene scene = test::scene_of(test::facing_square(), Material{});
        scene.instances[0].world_from_object = glm::mat4(0.5F * half_side);
        scene.instances[0].world_from_object[3] = {0, 0, 0, 1};
        return edge_count(scene, 16);
    };
    EXPECT_EQ(edges_of_a_square(1.0F), 0U) << "half-way between centers";
    const float pixel_width = 0.25F;
    // The outermost of the 10 x 10 pixels that the square covers, or almost covers.
    EXPECT_EQ(edges_of_a_square(1.125F + pixel_width / 64), 36U);
    EXPECT_EQ(edges_of_a_square(1.125F - pixel_width / 64), 36U);
    EXPECT_EQ(edges_of_a_square(1.125F + pixel_width / 16), 0U) << "beyond the margin";
}

TEST(ReferenceEdges, IncludeBordersOfFlatTriangles) {
    Material material;
    material.interpolation = Interpolation::flat;
    // The diagonal of the square passes through the centers of 16 pixels.
    EXPECT_EQ(edge_count(test::scene_of(test::facing_square(), material), 16), 16U);
}

/// The square is twice as large as the picture, so its border is far away.
Scene large_square(const Material& material) {
    Scene scene = test::scene_of(test::facing_square(), material);
    scene.instances[0].world_from_object = glm::mat4(2.0F);
    scene.instances[0].world_from_object[3] = {0, 0, 0, 1};
    return scene;
}

TEST(ReferenceEdges, IncludeBordersOfNearestTexels) {
    Material material;
    Texture texture;
    texture.filter = TextureFilter::nearest;
    material.diffuse_texture = texture;
    Scene scene = large_square(material);
    scene.images = {{"texture", test::constant_image({1, 1, 1, 1}, 3, 8, ColorSpace::srgb)}};
    // Two texels along a side: they meet between pixels if the picture has 16, and at the center of
    // pixels if it has 17.
    EXPECT_EQ(edge_count(scene, 16), 0U);
    EXPECT_EQ(edge_count(scene, 17), 33U);
    material.diffuse_texture->filter = TextureFilter::linear;
    scene.materials = {material};
    EXPECT_EQ(edge_count(scene, 17), 0U);
}

TEST(ReferenceEdges, IncludeMinifiedTextures) {
    Material material;
    material.diffuse_texture = Texture{0};
    Scene scene = large_square(material);
    for (const int size : {8, 64}) {
        scene.images = {{"texture", make_image(size, size, 3, 8, ColorSpace::srgb)}};
        EXPECT_EQ(edge_count(scene, 16), size > 16 ? 256U : 0U);
    }
}

TEST(ReferenceEdges, AreNotLookedForWithoutAMargin) {
    Material material;
    material.interpolation = Interpolation::flat;
    const Scene scene = test::scene_of(test::facing_square(), material);
    Report report;
    ReferenceSettings settings{16, 16, 0.0};
    const Reference reference = render_reference(scene, settings, report);
    for (const std::uint8_t edge : reference.edges.as<std::uint8_t>())
        EXPECT_EQ(edge, 0);
}

TEST(ReferenceEdges, IncludeCoincidentSurfaces) {
    Scene scene = test::scene_of(test::facing_square(), Material{});
    scene.instances.push_back(scene.instances[0]);
    EXPECT_EQ(edge_count(scene, 16), 256U);
    scene.instances[1].world_from_object[3].z = -0.01F;
    EXPECT_EQ(edge_count(scene, 16), 0U);
}

using test::storage_rounding;

/// A white surface under red, green and blue light from +x, +y and +z. Its radiance is the positive
/// part of its normal.
Scene measured(Mesh mesh, Material material = {}) {
    material.ambient = glm::vec3(0.0F);
    material.diffuse = glm::vec3(1.0F);
    Scene scene = test::scene_of(std::move(mesh), material);
    scene.directional_lights = {
        {{-1, 0, 0}, {1, 0, 0}}, {{0, -1, 0}, {0, 1, 0}}, {{0, 0, -1}, {0, 0, 1}}};
    return scene;
}

/// Returns the signed normal at a pixel. A second picture with reversed lights gives the negative
/// part.
glm::dvec3 normal_at(Scene scene, int size, int x, int y) {
    const glm::dvec3 positive = test::radiance_at(scene, size, x, y);
    for (DirectionalLight& light : scene.directional_lights)
        light.direction_world = -light.direction_world;
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
    // The weights at (1, 1, 0) are one quarter and three quarters.
    const glm::dvec3 found = normal_at(measured(mesh), 2, 1, 0);
    const glm::dvec3 expected = glm::normalize(glm::dvec3(0.75, 0, 0.25));
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(found[i], expected[i], storage_rounding);
}

TEST(ReferenceSurface, InterpolatesWithPerspective) {
    // The square is rotated about y: its left edge is at depth 2, its right one at depth 4, and its
    // width in x is 4.
    Mesh mesh = test::facing_square();
    for (std::size_t i = 0; i < 4; ++i) {
        mesh.positions[i].z = mesh.positions[i].x < 0 ? 1.0F : -1.0F;
        mesh.colors.emplace_back(mesh.positions[i].x < 0 ? 0.0F : 1.0F, 0.0F, 0.0F, 1.0F);
    }
    Material material = test::black_material();
    material.unlit = true;
    material.diffuse = glm::vec3(1.0F);
    Scene scene = test::scene_of(mesh, material);
    // The middle ray meets x = 0, the middle in space. On the screen, the edges are at -3 and 1.5.
    EXPECT_NEAR(test::radiance_at(scene, 3, 1, 1).r, 0.5, storage_rounding);
    // The ray of the pixel has the slope x / depth, and the surface has depth = 3 + x / 2.
    const double slope = (-2.0 + 4.0 * 2.5 / 4.0) / 3.0;  // x divided by depth.
    const double x = 3.0 * slope / (1.0 - slope * 0.5);   // Solved for x.
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
    place[0].x = -4.0F;  // Mirrored: x is reversed, and the front stays the front.
    expect_normal(scene, {-0.125, 0.125, 0.5});
    place[0].x = 4.0F;
    place[2].z = 0.0F;  // The mesh is flattened onto its own plane.
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

/// A map with one texel of these codes, under FlatCode::middle.
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
    // In 16 bits, the middle is 32768.
    Image fine = make_image(1, 1, 3, 16, ColorSpace::data);
    fine.samples = std::vector<std::uint16_t>{32768 + 6000, 32768 - 3000, 32768 + 20000};
    Scene sixteen = mapped(test::facing_square(), 0, 0, 0);
    sixteen.images[0].source = fine;
    expect_normal(sixteen, {6, -3, 20});
}

TEST(ReferenceSurface, ZeroTexelKeepsTheInterpolatedNormal) {
    Mesh mesh = test::facing_square();
    mesh.normals.assign(4, glm::normalize(glm::vec3(0.5F, 0.25F, 1.0F)));
    expect_normal(mapped(mesh, 0, 0, 0), {0.5, 0.25, 1});
}

TEST(ReferenceSurface, UsesTheStoredBasisAsInterpolated) {
    Mesh mesh = test::facing_square();
    mesh.tangents.assign(4, glm::vec4(1, 0, 0, 1));
    // The normals diverge. At the origin, their mean is (0, 0, cos 0.9), and the bitangent w
    // cross(n, t) has the same length.
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
            // The texture is rotated and sheared: u runs along (2, 1), v along (-1, 3).
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
            // dP/du is along (3, 1), where v is constant. v grows upwards unless it is mirrored.
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
    // The map has a tilt, but no tangent exists, so only its z remains.
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

/// A bump map of 64 texels per side whose heights increase by these steps per texel.
Scene bumped(float right, float down, float strength) {
    Material material;
    material.bump_map = BumpMap{Texture{0, Wrap::clamp, Wrap::clamp}, strength};
    Scene scene = measured(test::facing_square(), material);
    Image heights = make_image(64, 64, 1, 32, ColorSpace::data);
    auto samples = heights.as<float>();
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = right * static_cast<float>(i % 64) + down * static_cast<float>(i / 64);
    scene.images = {{"heights", heights}};
    return scene;
}

TEST(ReferenceSurface, TiltsAwayFromRisingBumps) {
    expect_normal(bumped(0.25F, 0, 2.0F), {-0.5, 0, 1});
    // Heights that increase downwards in the image decrease upwards, so the normal is tilted up.
    expect_normal(bumped(0, 0.25F, 2.0F), {0, 0.5, 1});
    expect_normal(bumped(0.125F, -0.25F, -2.0F), {0.25, 0.5, 1});
}

TEST(ReferenceSurface, IsInterpolatedWithoutTexcoords) {
    Scene scene = bumped(0.25F, 0, 2.0F);
    scene.meshes[0].edit().texcoords.clear();
    expect_normal(scene, {0, 0, 1});
}

}  // namespace
}  // namespace relief
