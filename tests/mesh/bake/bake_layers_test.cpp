// SPDX-License-Identifier: Apache-2.0
// Layers of a bake: each against its truth, and that none has a say in another.
#include "relief/mesh/bake_layers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "mesh/bake/bake_support.h"
#include "relief/mesh/error.h"
#include "relief/mesh/shapes.h"
#include "relief/mesh/threads.h"
#include "support/message_of.h"

namespace relief {
namespace {

using test::bake;
using test::BakedImage;
using test::moved;
using test::sized;

BakeOptions all_layers(int width, int height) {
    BakeOptions options = sized(width, height);
    options.layers.occlusion = OcclusionOptions{.rays = 8, .distance = {}};
    options.layers.curvature = true;
    options.layers.positions = true;
    options.layers.colors = true;
    return options;
}

/// A torus with colours, by place.
Mesh colored_torus() {
    Mesh mesh = make_torus(0.45F, 120, 60);
    for (const glm::vec3& position : mesh.positions)
        mesh.colors.emplace_back(0.5F + 0.3F * position, 0.5F);
    return mesh;
}

TEST(BakeLayers, HaveNoSayInEachOther) {
    const Mesh high = colored_torus();
    const Mesh low = make_torus();
    for (const auto& [samples, angle] :
         {std::pair<int, std::optional<double>>(1, {}), {16, {}}, {16, 0.02}}) {
        const auto with = [&](BakeOptions options) {
            options.samples = samples;
            options.sample_angle = angle;
            options.padding = 3;
            return bake({high}, low, options);
        };
        const BakedImage all = with(all_layers(70, 50));
        const auto only = [&](const auto& choose) {
            BakeOptions options = sized(70, 50);
            options.layers = {};
            options.layers.normals = false;
            choose(options.layers);
            return with(options);
        };
        const BakedImage normals = only([](BakeLayers& layers) { layers.normals = true; });
        EXPECT_EQ(normals.normals, all.normals);
        EXPECT_EQ(normals.states, all.states);
        EXPECT_TRUE(normals.heights.empty() && normals.occlusion.empty());
        EXPECT_TRUE(normals.curvature.empty() && normals.positions.empty());
        EXPECT_TRUE(normals.colors.empty());
        EXPECT_EQ(normals.result.rays, all.result.rays);
        EXPECT_EQ(normals.result.occlusion_rays, 0U);
        const BakedImage heights = only([](BakeLayers& layers) { layers.heights = true; });
        EXPECT_EQ(heights.heights, all.heights);
        EXPECT_TRUE(heights.normals.empty());
        EXPECT_EQ(only([](BakeLayers& layers) {
                      layers.occlusion = {8, {}};
                  }).occlusion,
                  all.occlusion);
        EXPECT_EQ(only([](BakeLayers& layers) { layers.curvature = true; }).curvature,
                  all.curvature);
        EXPECT_EQ(only([](BakeLayers& layers) { layers.positions = true; }).positions,
                  all.positions);
        EXPECT_EQ(only([](BakeLayers& layers) { layers.colors = true; }).colors, all.colors);
        set_thread_limit(1);
        const BakedImage alone = with(all_layers(70, 50));
        set_thread_limit(0);
        EXPECT_EQ(alone.occlusion, all.occlusion);
        EXPECT_EQ(alone.curvature, all.curvature);
        EXPECT_EQ(alone.positions, all.positions);
        EXPECT_EQ(alone.colors, all.colors);
    }
}

TEST(BakeLayers, PositionsAreWhereRaysHaveHitInTheAxesAskedFor) {
    BakeOptions options = sized(8, 4);
    options.layers.positions = true;
    options.layers.position_from_mesh =
        glm::translate(glm::dmat4(1.0), {10.0, 20.0, 30.0}) * glm::dmat4(glm::dmat3(2.0));
    const BakedImage image = bake({moved(make_quad(), 1.0F, {0, 0, 0.25F})}, make_quad(), options);
    for (std::size_t i = 0; i < 32; ++i) {
        const double x = (static_cast<double>(i % 8) + 0.5) / 4.0 - 1.0;
        const double y = 1.0 - (static_cast<double>(i / 8) + 0.5) / 2.0;
        EXPECT_NEAR(image.positions[3 * i], 10.0 + 2.0 * x, 1e-5);
        EXPECT_NEAR(image.positions[3 * i + 1], 20.0 + 2.0 * y, 1e-5);
        EXPECT_NEAR(image.positions[3 * i + 2], 30.5, 1e-5);
    }
}

TEST(BakeLayers, CurvatureIsThatOfTheHighMesh) {
    BakeOptions options = sized(64, 32);
    options.layers.curvature = true;
    const Mesh high = moved(make_sphere(256, 128), 2.5F, glm::vec3(0));
    const Mesh low = moved(make_sphere(32, 16), 2.5F, glm::vec3(0));
    for (const float here : bake({high}, low, options).curvature)
        EXPECT_NEAR(here, 0.4, 0.001);
    // Seen from inside the same surface is hollow.
    Mesh turned = high;
    for (glm::uvec3& triangle : turned.triangles)
        std::swap(triangle.y, triangle.z);
    options.back_faces = BackFaces::take;
    for (const float here : bake({turned}, low, options).curvature)
        EXPECT_NEAR(here, 0.4, 0.001);
}

TEST(BakeLayers, OcclusionIsThatOfTheHighMeshes) {
    // A floor, and 0.5 above it a roof that rays begin below: half a turn of sky is left at its
    // rim, none to speak of well below it.
    Mesh roof = moved(make_quad(), 8.0F, {8.0F, 0, 0.5F});
    BakeOptions options = sized(33, 1);
    options.layers.occlusion = OcclusionOptions{.rays = 1024, .distance = 100.0};
    options.offset = 0.25;
    options.max_distance = 0.25;
    options.allow_size_mismatch = true;
    const BakedImage image =
        bake({moved(make_quad(), 8.0F, glm::vec3(0)), roof}, make_quad(), options);
    EXPECT_EQ(image.result.occlusion_rays, 33U * 1024U);
    for (std::size_t i = 0; i < 33; ++i) {
        const double x = (static_cast<double>(i) + 0.5) / 16.5 - 1.0;
        // An endless half plane: half of 1 minus the sine of its rim's angle from upright.
        const double ground_truth = 0.5 * (1.0 - x / std::hypot(x, 0.5));
        EXPECT_NEAR(image.occlusion[i], ground_truth, 0.01) << x;
    }
}

TEST(BakeLayers, OfTexelsThatMissAreBackgroundOrPadded) {
    Mesh high = moved(make_quad(), 1.0F, {0, 0, 0.25F});
    for (glm::vec3& position : high.positions)
        position.x = (position.x - 1.0F) / 2.0F;
    high.colors.assign(4, {0.25F, 0.5F, 0.75F, 1.0F});
    BakeOptions options = all_layers(16, 4);
    options.padding = 2;
    const BakedImage image = bake({high}, make_quad(), options);
    for (const std::size_t i : {7UL, 9UL}) {
        EXPECT_EQ(image.occlusion[i], 1.0F);
        EXPECT_EQ(image.colors[3 * i + 1], 0.5F);
        EXPECT_NEAR(image.positions[3 * i], -0.0625F, 1e-6F);
    }
    EXPECT_EQ(image.states[10], TexelState::missed);
    EXPECT_EQ(image.occlusion[10], 1.0F);
    EXPECT_EQ(image.colors[31], 0.0F);
    EXPECT_EQ(image.positions[30], 0.0F);
}

TEST(BakeLayers, ColorsOfVerticesAreMixedInLight) {
    Mesh high = make_quad();
    for (const glm::vec3& position : high.positions)
        high.colors.emplace_back(0.5F + 0.5F * position.x, 0.25F, 0.0F, 0.5F);
    Mesh bare = moved(make_quad(), 1.0F, {2.0F, 0, 0});
    Mesh low = make_quad();
    for (glm::vec3& position : low.positions)
        position.x = 1.0F + 2.0F * position.x;
    BakeOptions options = sized(16, 1);
    options.layers.colors = true;
    options.samples = 4;
    const BakedImage image = bake({high, bare}, low, options);
    for (std::size_t i = 0; i < 16; ++i) {
        const double red = i < 8 ? (static_cast<double>(i) + 0.5) / 8.0 : 1.0;
        EXPECT_NEAR(image.colors[3 * i], red, 1e-6);
        EXPECT_NEAR(image.colors[3 * i + 1], i < 8 ? 0.25 : 1.0, 1e-6);
    }
    EXPECT_EQ(image.report.count("high mesh without colours"), 1U);
    EXPECT_EQ(image.report.findings()[0].first, (std::vector<std::size_t>{1}));
}

TEST(BakeLayers, SaysWhatIsWrong) {
    BakeOptions options = sized(4, 4);
    options.layers.occlusion = OcclusionOptions{.rays = 0, .distance = {}};
    EXPECT_EQ(test::message_of<InvalidInput>([&] { bake({make_quad()}, make_quad(), options); }),
              "0 rays of occlusion are not within 1 to 65536");
    options.layers.occlusion = OcclusionOptions{.rays = 4, .distance = -1.0};
    EXPECT_EQ(test::message_of<InvalidInput>([&] { bake({make_quad()}, make_quad(), options); }),
              "a distance of occlusion of -1 is negative or not finite");
}

TEST(BakeLayers, OfAMapAreSomeOfThoseThatItsBakerWasMadeFor) {
    const std::vector<Mesh> high = {make_quad()};
    BakeOptions options = sized(4, 4);
    Report report;
    const Baker baker(high, make_quad(), options, report);
    BakeMapOptions map = options;
    map.layers = {.normals = false, .positions = true};
    std::size_t rows = 0;
    baker.bake(
        map,
        [&](const BakedRows& baked) {
            EXPECT_EQ(baked.positions.size(), 48U);
            EXPECT_TRUE(baked.normals.empty() && baked.heights.empty());
            ++rows;
        },
        report);
    EXPECT_EQ(rows, 1U);
    map.layers.curvature = true;
    EXPECT_EQ(test::message_of<InvalidInput>([&] {
                  baker.bake(
                      map, [](const auto&) {}, report);
              }),
              "a map wants a layer that its baker was not made for");
}

}  // namespace
}  // namespace relief
