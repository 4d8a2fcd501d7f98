// SPDX-License-Identifier: Apache-2.0
// Wireframe, vertex frames and markers as pixels: their positions, colors and occlusion. Other
// pixels do not change.
#include "render/overlays.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "relief/mesh/frames.h"
#include "relief/mesh/report.h"
#include "shade/effects/feature_sets.h"
#include "shade/render/draw_support.h"
#include "support/invariants.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::shade;
using namespace relief::shade::detail;

namespace {

using test::pixel;

constexpr int overlay_size = 64;

/// A square of 2 x 2, seen from the front: it covers pixels 16 to 47 of 64.
Scene small_square() {
    Scene scene = test::scene_of(test::facing_square(), test::black_material());
    scene.materials[0].emission = glm::vec3(0.25F);
    scene.instances[0].world_from_object[0][0] = scene.instances[0].world_from_object[1][1] = 0.5F;
    return scene;
}

FrameSettings picture(int samples = 1) {
    return {.width = overlay_size,
            .height = overlay_size,
            .samples = samples,
            .output = OutputCoding::srgb};
}

glm::dvec4 code(const glm::vec3& srgb) {
    return {glm::round(255.0 * glm::dvec3(srgb)), 255.0};
}

class Overlay : public test::DrawTest {};

TEST_F(Overlay, WireframeDrawsOnlyEdges) {
    Scene scene = small_square();
    scene.exposure = 3.0F;
    scene.tone_mapping = ToneMapping::reinhard;
    scene.background = {0, 0, 0, 1};
    for (const int samples : {1, 4}) {
        FrameSettings settings = picture(samples);
        const Image plain = render(scene, settings).image;
        settings.overlays.wireframe = true;
        const Image wired = render(scene, settings).image;
        int drawn = 0;
        for (int y = 0; y < overlay_size; ++y) {
            for (int x = 0; x < overlay_size; ++x) {
                const bool is_wire = pixel(wired, x, y) == code(wireframe_color);
                if (!is_wire) {
                    EXPECT_EQ(pixel(wired, x, y), pixel(plain, x, y)) << x << "," << y;
                }
                // Within a pixel of a side of the square, or of one of its diagonals.
                const double right = std::abs(std::abs(x + 0.5 - 32.0) - 16.0);
                const double up = std::abs(std::abs(y + 0.5 - 32.0) - 16.0);
                const double diagonal =
                    std::abs(std::abs(x + 0.5 - 32.0) - std::abs(y + 0.5 - 32.0));
                if (is_wire) {
                    EXPECT_LE(std::min({right, up, diagonal}), 1.0) << x << "," << y;
                }
                drawn += is_wire ? 1 : 0;
            }
        }
        EXPECT_NEAR(drawn, 4 * 32 + 32, 8) << samples << " samples";
    }
}

TEST_F(Overlay, LinesAreHiddenByOpaqueSurfacesAlone) {
    Scene scene = small_square();
    Instance cover = scene.instances[0];  // It is larger and nearer.
    cover.world_from_object = glm::mat4(1.0F);
    cover.world_from_object[3].z = 0.5F;
    scene.instances.push_back(cover);
    FrameSettings settings = picture();
    settings.overlays.vertex_frames = 0.05F;
    const auto count = [&](const Image& image, const glm::vec3& color) {
        int found = 0;
        for (int i = 0; i < overlay_size * overlay_size; ++i)
            found += pixel(image, i % overlay_size, i / overlay_size) == code(color) ? 1 : 0;
        return found;
    };
    EXPECT_EQ(count(render(scene, settings).image, tangent_color), 0);
    scene.instances.pop_back();
    // Four vertices, each with a line of 0.05 times the diagonal: 0.14 units of 16 pixels.
    EXPECT_NEAR(count(render(scene, settings).image, tangent_color), 4 * 2.3, 4.0);
    EXPECT_NEAR(count(render(scene, settings).image, bitangent_color), 4 * 2.3, 4.0);
}

TEST_F(Overlay, TheGridIsBelowTheSceneAndBehindItsSurfaces) {
    Scene scene = small_square();
    scene.instances[0].world_from_object =
        glm::rotate(glm::mat4(1.0F), -glm::radians(90.0F), glm::vec3(1, 0, 0));
    FrameSettings settings = picture();
    settings.overlays.grid = grid_below(world_bounds(scene));
    const auto count = [&](const Image& image, const glm::vec3& color) {
        int found = 0;
        for (int i = 0; i < overlay_size * overlay_size; ++i)
            found += pixel(image, i % overlay_size, i / overlay_size) == code(color) ? 1 : 0;
        return found;
    };
    // Seen along z, the grid is one line. Its nearest line hides the x axis.
    const Image from_the_side = render(scene, settings).image;
    EXPECT_GT(count(from_the_side, bitangent_color), 10);
    EXPECT_GT(count(from_the_side, grid_color), 10);
    const Image without = render(scene, picture()).image;
    int above = 0;
    for (int y = overlay_size / 2 + 2; y < overlay_size; ++y) {
        for (int x = 0; x < overlay_size; ++x)
            above += pixel(from_the_side, x, y) == pixel(without, x, y) ? 0 : 1;
    }
    EXPECT_EQ(above, 0) << "nothing is below the grid";
}

TEST(GridBelow, HasARoundSpacing) {
    const auto spacing_of = [](float size) {
        return grid_below({{0, 0, -0.5F * size}, {size, 0, 0}}).spacing;
    };
    EXPECT_DOUBLE_EQ(spacing_of(1.0F), 0.1);
    EXPECT_DOUBLE_EQ(spacing_of(1.5F), 0.2);
    EXPECT_DOUBLE_EQ(spacing_of(4.0F), 0.5);
    EXPECT_DOUBLE_EQ(spacing_of(7.0F), 1.0);
    EXPECT_DOUBLE_EQ(spacing_of(3e6F), 5e5);
    EXPECT_DOUBLE_EQ(spacing_of(2e-20F), 2e-21);
    EXPECT_DOUBLE_EQ(spacing_of(0.0F), 1.0);
    EXPECT_EQ(grid_below(Bounds()), Grid());
    const float most = std::numeric_limits<float>::max();
    EXPECT_LE(grid_below({glm::vec3(-most), glm::vec3(most)}).cells, 9);
}

TEST(GridBelow, IsAtTheLowestPointWithLinesAtMultiplesOfTheSpacing) {
    const Grid grid = grid_below({{9.3F, 2.0F, -1.0F}, {13.3F, 7.0F, 2.0F}});  // 4 wide.
    EXPECT_EQ(grid, (Grid{{11.5, 2.0, 0.5}, 0.5, 7}));
    const GridLines lines = grid_lines(grid);
    ASSERT_EQ(lines.cells.size(), 2U * 2U * 15U);
    for (const glm::vec3& point : lines.cells) {
        EXPECT_EQ(point.y, 0.0F);
        EXPECT_FLOAT_EQ(point.x, 0.5F * std::round(2.0F * point.x));
        EXPECT_FLOAT_EQ(point.z, 0.5F * std::round(2.0F * point.z));
    }
    EXPECT_EQ(lines.axes[0][1], glm::vec3(3.5F, 0.0F, 0.0F));
    EXPECT_EQ(lines.axes[1][1], glm::vec3(0.0F, 3.5F, 0.0F));
    EXPECT_EQ(lines.axes[2][1], glm::vec3(0.0F, 0.0F, 3.5F));
}

TEST_F(Overlay, FramesPointAlongTheirDirections) {
    const Scene scene = small_square();
    FrameSettings settings = picture();
    settings.overlays.vertex_frames = 0.25F;  // A quarter of sqrt(8): 0.707 units, 11.3 pixels.
    const Image image = render(scene, settings).image;
    // From the lower left corner at pixel (16, 48), the tangent goes to the right and the bitangent
    // up.
    EXPECT_TRUE(pixel(image, 22, 47) == code(tangent_color) ||
                pixel(image, 22, 48) == code(tangent_color));
    EXPECT_TRUE(pixel(image, 15, 42) == code(bitangent_color) ||
                pixel(image, 16, 42) == code(bitangent_color));
    EXPECT_NE(pixel(image, 30, 47), code(tangent_color));
    EXPECT_NE(pixel(image, 30, 48), code(tangent_color));
}

TEST_F(Overlay, MarkersAreDiscsOnTopInTheirColor) {
    Scene scene = small_square();
    FrameSettings settings = picture();
    const glm::vec3 color(1.0F, 0.0F, 0.4F);
    // The marker is behind the surface, 0.5 units to the right of the middle after the scale of the
    // instance.
    settings.overlays.markers =
        std::make_shared<std::vector<Marker>>(1, Marker{0, {1.0F, 0.0F, -0.001F}, color});
    Report report;
    Renderer renderer(context(), scene, settings, report);
    const Image image = renderer.draw(*scene.camera).image;
    for (const int reach : {-3, 0, 3}) {
        EXPECT_EQ(pixel(image, 40 + reach, 32), code(color));
        EXPECT_EQ(pixel(image, 40, 32 + reach), code(color));
    }
    EXPECT_NE(pixel(image, 40 + 6, 32), code(color));
    EXPECT_NE(pixel(image, 40 + 4, 32 + 4), code(color)) << "a disc has no corners";
    // The marker moves with its instance.
    scene.instances[0].world_from_object[3].x = -0.5F;
    renderer.move(scene);
    const Image moved = renderer.draw(*scene.camera).image;
    EXPECT_EQ(pixel(moved, 32, 32), code(color));
    EXPECT_NE(pixel(moved, 40, 32), code(color));
}

TEST_F(Overlay, FollowsDeformedMeshes) {
    FrameOptions frames;
    frames.tangents = TangentMethod::mikktspace;
    Scene scene =
        test::scene_of(with_frames(test::sphere(12, 8), frames).mesh, test::black_material());
    Features bent;
    bent.morphing = bent.skinning = true;
    scene.instances[0].pose = test::pose_calling_for(scene.meshes[0], bent);
    FrameSettings settings = picture();
    settings.overlays.wireframe = true;
    settings.overlays.vertex_frames = 0.1F;
    Scene baked = scene;  // The deformed mesh as a mesh at rest.
    baked.meshes[0] = deformed_mesh(scene, 0);
    baked.instances[0].pose.reset();
    const Image drawn = render(scene, settings).image;
    const Image expected = render(baked, settings).image;
    int differing = 0;  // Rounding may move a line by a pixel.
    for (int y = 0; y < drawn.height; ++y) {
        for (int x = 0; x < drawn.width; ++x)
            differing += pixel(drawn, x, y) != pixel(expected, x, y) ? 1 : 0;
    }
    EXPECT_LE(differing, drawn.width * drawn.height / 200);
    scene.instances[0].pose.reset();
    EXPECT_FALSE(test::same_bits(drawn, render(scene, settings).image));
}

TEST_F(Overlay, ColorsAreLinearInALinearPicture) {
    const Scene scene = small_square();
    FrameSettings settings = picture();
    settings.output = OutputCoding::linear;
    settings.overlays.markers =
        std::make_shared<std::vector<Marker>>(1, Marker{0, {}, glm::vec3(0.5F, 0, 1)});
    const glm::dvec4 found = pixel(render(scene, settings).image, 32, 32);
    EXPECT_NEAR(found.x, 0.2140411, 1e-6);
    EXPECT_EQ(found.y, 0.0);
    EXPECT_EQ(found.z, 1.0);
}

TEST_F(Overlay, RefusesInvalidMarkers) {
    const Scene scene = small_square();
    FrameSettings settings = picture();
    const auto message = [&] {
        return test::message_of<InvalidInput>([&] { (void)render(scene, settings); });
    };
    settings.overlays.vertex_frames = 0.0F;
    EXPECT_THAT(message(), testing::HasSubstr("the length of vertex frames is 0 times"));
    settings.overlays.vertex_frames.reset();
    settings.overlays.markers = std::make_shared<std::vector<Marker>>(1, Marker{7, {}, {}});
    EXPECT_THAT(message(), testing::HasSubstr("marker 0 is on instance 7, but there are only 1"));
}

}  // namespace
}  // namespace relief
