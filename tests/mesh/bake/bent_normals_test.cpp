// SPDX-License-Identifier: Apache-2.0
// Bent normals against closed forms: beside a wall, under a disc, on open and on hidden surfaces.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "mesh/bake/bake_support.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/mesh.h"
#include "support/invariants.h"

namespace relief {
namespace {

using test::bake;
using test::BakedImage;
using test::degrees_between;
using test::moved;
using test::sized;

constexpr int many_rays = 1024;
constexpr double max_error = 0.4;  // Of a texel with as many rays, in degrees.

/// Options for bent normals alone, with distances for surfaces that coincide.
BakeOptions bent_options(int width, int height, int rays = many_rays) {
    BakeOptions options = sized(width, height);
    options.map.layers = {.normals = false,
                          .bent_normals = OcclusionOptions{.rays = rays, .distance = 1e4}};
    options.offset = options.max_distance = 0.01;
    options.allow_size_mismatch = true;
    return options;
}

/// A floor of 2 x 2 at z = 0, and a wall of 2000 x 2000 through x = -1 whose normal is at an angle
/// about z from the x axis.
std::vector<Mesh> floor_beside_wall(double angle) {
    Mesh wall = moved(make_quad(), 1000.0F, glm::vec3(0.0F));
    const auto c = static_cast<float>(std::cos(angle));
    const auto s = static_cast<float>(std::sin(angle));
    for (glm::vec3& p : wall.positions) {
        p = glm::vec3(0.0F, p.x, p.y);  // It faces +x.
        p = glm::vec3(c * p.x - s * p.y, s * p.x + c * p.y, p.z);
        p -= 1.5F * glm::vec3(c, s, 0.0F);
    }
    wall.normals.assign(4, glm::vec3(c, s, 0.0F));
    return {make_quad(), wall};
}

/// The cosine-weighted mean over the half of the hemisphere in front of an infinite wall: 1/3 along
/// the normal of the floor, and 2/(3 pi) along that of the wall.
glm::dvec3 beside_wall(double angle) {
    const double away = 2.0 / (3.0 * std::numbers::pi);
    return glm::normalize(glm::dvec3(away * std::cos(angle), away * std::sin(angle), 1.0 / 3.0));
}

TEST(BentNormals, BesideAWallAreTheirClosedForm) {
    for (const double angle : {0.0, 0.5, 2.0}) {
        const BakedImage image = bake(floor_beside_wall(angle), make_quad(), bent_options(6, 5));
        double sum = 0.0;
        for (std::size_t i = 0; i < 30; ++i) {
            const double error = degrees_between(image.bent_normal(i), beside_wall(angle));
            // The error of a texel is 0.09 degrees (RMS); of 4096 texels, none exceeds 0.29.
            EXPECT_LT(error, max_error) << angle << ", texel " << i;
            sum += error / 30.0;
            EXPECT_NEAR(glm::length(image.bent_normal(i)), 1.0, 1e-6);
        }
        EXPECT_LT(sum, 0.15) << angle;
        EXPECT_TRUE(image.report.empty());
        EXPECT_EQ(image.result.occlusion_rays, 30U * many_rays);
    }
}

TEST(BentNormals, FollowMirroredTextureCoordinates) {
    Mesh low = make_quad();
    for (glm::vec2& texcoord : low.texcoords)
        texcoord.x = 1.0F - texcoord.x;
    const glm::dvec3 expected = beside_wall(0.5) * glm::dvec3(-1.0, 1.0, 1.0);
    const BakedImage image = bake(floor_beside_wall(0.5), low, bent_options(4, 4));
    for (std::size_t i = 0; i < 16; ++i)
        EXPECT_LT(degrees_between(image.bent_normal(i), expected), max_error) << i;
}

TEST(BentNormals, AreInTheSpaceOfTheNormals) {
    BakeOptions options = bent_options(4, 4);
    options.space = VectorSpace::object;
    options.output_from_mesh = glm::dmat3(0, 1, 0, 0, 0, 1, 1, 0, 0);  // x to y, y to z, z to x
    const glm::dvec3 here = beside_wall(0.5);
    const BakedImage image = bake(floor_beside_wall(0.5), make_quad(), options);
    for (std::size_t i = 0; i < 16; ++i)
        EXPECT_LT(degrees_between(image.bent_normal(i), {here.z, here.x, here.y}), max_error) << i;
}

TEST(BentNormals, OfOpenSurfacesAreTheirNormals) {
    // Not even the distribution of few rays, or the planes of coarse triangles, turn them.
    const BakedImage flat = bake({make_quad()}, make_quad(), bent_options(8, 8, 4));
    for (std::size_t i = 0; i < 64; ++i)
        EXPECT_EQ(flat.bent_normal(i), glm::dvec3(0, 0, 1));
    BakeOptions options = bent_options(32, 16, 4);
    options.map.layers.normals = true;
    options.offset = options.max_distance = 0.5;
    const BakedImage ball = bake({make_sphere(24, 12)}, make_sphere(16, 8), options);
    for (std::size_t i = 0; i < 32UL * 16; ++i) {
        if (ball.states[i] != TexelState::baked) continue;
        EXPECT_LT(degrees_between(ball.bent_normal(i), ball.normal(i)), 1e-4) << i;
    }
}

TEST(BentNormals, UnderACenteredRoofAreTheNormal) {
    // The roof hides the directions about the normal evenly. It is so far away that it is centered
    // above all texels: a shift of 0.001 of its height turns them by 0.05 degrees.
    const std::vector<Mesh> high = {make_quad(), moved(make_quad(), 1000.0F, {0, 0, 1000.0F})};
    const BakedImage image = bake(high, make_quad(), bent_options(4, 4));
    // Beside a wall, one border crosses the disc of directions, and the mean of the open ones has
    // the length 0.4. Here, four borders double the error of the mean, which has the length 0.2.
    for (std::size_t i = 0; i < 16; ++i)
        EXPECT_LT(degrees_between(image.bent_normal(i), {0, 0, 1}), 4.0 * max_error) << i;
}

TEST(BentNormals, WithoutAnOpenRayAreTheNormal) {
    Mesh hollow = moved(make_cube(), 50.0F, glm::vec3(0.0F));
    BakeOptions options = bent_options(4, 4, 64);
    options.map.samples = 4;
    const BakedImage image = bake({make_quad(), hollow}, make_quad(), options);
    for (std::size_t i = 0; i < 16; ++i)
        EXPECT_EQ(image.bent_normal(i), glm::dvec3(0, 0, 1)) << i;
    EXPECT_EQ(image.report.count("texel without an open ray"), 16U);
}

TEST(BentNormals, OfInsideOutPartsPointOutwards) {
    std::vector<Mesh> high = floor_beside_wall(0.5);
    for (glm::uvec3& triangle : high[0].triangles)
        std::swap(triangle.y, triangle.z);
    for (glm::vec3& normal : high[0].normals)
        normal = -normal;
    BakeOptions options = bent_options(4, 4);
    options.back_faces = BackFaces::take;
    const BakedImage image = bake(high, make_quad(), options);
    for (std::size_t i = 0; i < 16; ++i)
        EXPECT_LT(degrees_between(image.bent_normal(i), beside_wall(0.5)), max_error) << i;
}

TEST(BentNormals, ShareTheRaysOfOcclusion) {
    BakeOptions options = bent_options(5, 5, 256);
    const BakedImage bent = bake(floor_beside_wall(0.5), make_quad(), options);
    options.map.layers.occlusion = options.map.layers.bent_normals;
    const BakedImage both = bake(floor_beside_wall(0.5), make_quad(), options);
    options.map.layers.bent_normals.reset();
    const BakedImage occlusion = bake(floor_beside_wall(0.5), make_quad(), options);
    EXPECT_EQ(both.result.occlusion_rays, 25U * 256U);
    EXPECT_EQ(both.bent_normals, bent.bent_normals);
    EXPECT_EQ(both.occlusion, occlusion.occlusion);
    EXPECT_TRUE(bent.occlusion.empty() && occlusion.bent_normals.empty());
}

TEST(BentNormals, OfMissedTexelsAreFlatOrPadding) {
    Mesh high = make_quad();
    for (glm::vec3& position : high.positions)
        position.x = (position.x - 1.0F) / 2.0F;
    BakeOptions options = bent_options(16, 1, 16);
    options.map.padding = 2;
    const BakedImage image = bake({high}, make_quad(), options);
    EXPECT_EQ(image.states[9], TexelState::padded);
    EXPECT_EQ(image.bent_normal(9), glm::dvec3(0, 0, 1));
    EXPECT_EQ(image.states[12], TexelState::missed);
    EXPECT_EQ(image.bent_normal(12), glm::dvec3(0, 0, 1));
}

TEST(BentNormals, AreEncodedAsNormalMaps) {
    const std::vector<float> values = {0.28F, 0.0F, 0.96F, 0.0F, 1.0F, 0.0F};
    const std::vector<TexelState> states = {TexelState::baked, TexelState::empty};
    LayerCoding coding{.kind = LayerKind::bent_normal, .bits = 8};
    const auto codes = [&](bool has_alpha) {
        std::vector<int> all;
        for (const std::byte code : encode_layer(values, states, coding, has_alpha, 0))
            all.push_back(static_cast<int>(code));
        return all;
    };
    EXPECT_EQ(codes(false), (std::vector<int>{163, 128, 250, 128, 255, 128}));
    coding.normal_format = {.green = Green::down, .flat = FlatCode::middle};
    EXPECT_EQ(codes(true), (std::vector<int>{164, 128, 250, 255, 128, 1, 128, 0}));
    const auto metadata = layer_metadata(coding);
    EXPECT_EQ(metadata.at("relief:content"), "bent normals, tangent space");
    EXPECT_EQ(metadata.at("relief:green"), "down");
    EXPECT_EQ(metadata.at("relief:flat"), "128");
    EXPECT_EQ(coding.channels(), 3U);
    coding.space = VectorSpace::world;
    EXPECT_EQ(layer_metadata(coding).at("relief:content"), "bent normals, world space");
}

}  // namespace
}  // namespace relief
