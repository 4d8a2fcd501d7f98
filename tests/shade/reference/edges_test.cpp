// SPDX-License-Identifier: Apache-2.0
// What counts as near an edge: silhouettes and other jumps, and nothing that is smooth.
#include <gtest/gtest.h>

#include "support/shapes.h"
#include "traced.h"

namespace relief {
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
    // 16 pixels are 4 units: centres lie at 0.125, 0.375, ..., 1.125.
    const auto edges_of_a_square = [](float half_side) {
        Scene scene = test::scene_of(test::facing_square(), Material{});
        scene.instances[0].world_from_object = glm::mat4(0.5F * half_side);
        scene.instances[0].world_from_object[3] = {0, 0, 0, 1};
        return edge_count(scene, 16);
    };
    EXPECT_EQ(edges_of_a_square(1.0F), 0U) << "half-way between centres";
    const float pixel_width = 0.25F;
    // The outermost of 10 x 10 pixels that it covers, or nearly covers.
    EXPECT_EQ(edges_of_a_square(1.125F + pixel_width / 64), 36U);
    EXPECT_EQ(edges_of_a_square(1.125F - pixel_width / 64), 36U);
    EXPECT_EQ(edges_of_a_square(1.125F + pixel_width / 16), 0U) << "beyond the margin";
}

TEST(ReferenceEdges, AreWhereFlatTrianglesMeet) {
    Material material;
    material.interpolation = Interpolation::flat;
    // 16 pixels: the square's diagonal passes through the centres of one diagonal of them.
    EXPECT_EQ(edge_count(test::scene_of(test::facing_square(), material), 16), 16U);
}

/// The square twice as large as the picture, so that its border is nowhere near.
Scene large_square(const Material& material) {
    Scene scene = test::scene_of(test::facing_square(), material);
    scene.instances[0].world_from_object = glm::mat4(2.0F);
    scene.instances[0].world_from_object[3] = {0, 0, 0, 1};
    return scene;
}

TEST(ReferenceEdges, AreWhereNearestTexelsMeet) {
    Material material;
    Texture texture;
    texture.filter = TextureFilter::nearest;
    material.diffuse_texture = texture;
    Scene scene = large_square(material);
    scene.images = {{"texture", test::constant_image({1, 1, 1, 1}, 3, 8, ColorSpace::srgb)}};
    // Two texels a side: they meet between the pixels of 16, and at centres of the middle ones of
    // 17.
    EXPECT_EQ(edge_count(scene, 16), 0U);
    EXPECT_EQ(edge_count(scene, 17), 33U);
    material.diffuse_texture->filter = TextureFilter::linear;
    scene.materials = {material};
    EXPECT_EQ(edge_count(scene, 17), 0U);
}

TEST(ReferenceEdges, AreWhereATextureIsMinified) {
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

TEST(ReferenceEdges, AreWhereTwoSurfacesAreTooCloseToTellApart) {
    Scene scene = test::scene_of(test::facing_square(), Material{});
    scene.instances.push_back(scene.instances[0]);
    EXPECT_EQ(edge_count(scene, 16), 256U);
    scene.instances[1].world_from_object[3].z = -0.01F;
    EXPECT_EQ(edge_count(scene, 16), 0U);
}

}  // namespace
}  // namespace relief
