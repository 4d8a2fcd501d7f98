// SPDX-License-Identifier: Apache-2.0
// The bound below which a relief is left out: what its pictures lack then, over the scenes of data/
// and generated ones. docs/relief-mapping.md has the figures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <utility>
#include <vector>

#include "effects/features.h"
#include "relief/shade/effects.h"
#include "relief/shade/renderer.h"
#include "relief/shade/scene_file.h"
#include "shade/render/draw_support.h"
#include "support/labels.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::shade;

namespace {

using testing::HasSubstr;

/// The last one is next to nothing: what remains are the programs' own differences.
constexpr std::array bounds_measured = {0.5F, 0.25F, 0.1F, 0.05F, 0.02F, 1.0F / 255.0F, 1e-4F};

/// The differences of two pictures.
struct Change {
    double largest = 0.0;  ///< In codes of 255, or of linear radiance.
    double above = 0.0;    ///< The fraction of pixels that differ by more than 1.
};

Change change_between(const Image& a, const Image& b) {
    Change change;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            const glm::dvec4 apart = glm::abs(test::pixel(a, x, y) - test::pixel(b, x, y));
            const double largest = std::max({apart.r, apart.g, apart.b});
            change.largest = std::max(change.largest, largest);
            change.above += largest > 1.0 ? 1.0 : 0.0;
        }
    }
    change.above /= static_cast<double>(a.width) * a.height;
    return change;
}

/// Returns the largest shift of a scene's reliefs on the screen, in pixels.
double shift_of(const Scene& scene, const FrameSettings& settings) {
    double shift = 0.0;
    for (const Instance& instance : scene.instances) {
        for (const MaterialRange& range : scene.meshes[instance.mesh]->material_ranges) {
            const auto bounds = shade::detail::relief_bounds(scene, instance, range, settings);
            if (bounds) shift = std::max(shift, bounds->shift);
        }
    }
    return shift;
}

/// Gives all reliefs the bound, and a depth with which they shift just less than that.
Scene just_below(Scene scene, float bound, const FrameSettings& settings) {
    float depth = 0.01F;
    for (int i = 0; i < 4; ++i) {
        for (Material& material : scene.materials) {
            if (!material.height_map) continue;
            material.height_map->depth = depth;
            material.height_map->bound = bound;
        }
        depth *= 0.999F * bound / static_cast<float>(shift_of(scene, settings));
    }
    return scene;
}

std::string without_extension(const std::filesystem::path& file) {
    return file.stem().string();
}

/// The scenes of data/; all materials that have none get the relief and the colors of bricks.
std::vector<std::pair<std::string, Scene>> sample_scenes() {
    const std::filesystem::path data = test::source_directory() / "data";
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(data / "scenes")) {
        if (entry.path().extension() == ".json") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    std::vector<std::pair<std::string, Scene>> scenes;
    for (const std::filesystem::path& file : files) {
        Scene scene = load_scene(file);
        const auto image = static_cast<std::uint32_t>(scene.images.size());
        scene.images.push_back({"heights", data / "bricks-height.png"});
        scene.images.push_back({"colors", data / "bricks-diffuse.png"});
        for (Material& material : scene.materials) {
            if (material.interpolation == Interpolation::gouraud) continue;
            if (!material.height_map) material.height_map.emplace().texture = Texture{image};
            if (!material.diffuse_texture) material.diffuse_texture = Texture{image + 1};
        }
        scenes.emplace_back(without_extension(file), std::move(scene));
    }
    return scenes;
}

class ReliefBoundTest : public test::DrawTest {
  protected:
    /// Compares the planned picture with that in which all reliefs are forced on.
    /// \return none if the plan has a relief
    [[nodiscard]] Change left_out(const Scene& scene, const FrameSettings& settings) const {
        const FramePlan plan = plan_effects(scene, settings);
        const bool is_planned = std::any_of(
            plan.draws.begin(), plan.draws.end(),
            [](const DrawPlan& draw) { return draw.features.depth_mapping != DepthMapping::none; });
        EXPECT_FALSE(is_planned);
        const EffectRequest forced{EffectBase::planned, {{"maximum mipmaps", true}}};
        return change_between(
            render(scene, plan, settings).image,
            render(scene, force_effects(scene, settings, plan, forced), settings).image);
    }
};

/// A checkerboard of black and white texels, 32 x 32 on a square 4 long, without light.
Scene checkerboard(double degrees, int period) {
    constexpr int side = 32;
    Image colors = make_image(side, side, 1, 32, ColorSpace::data);
    Image heights = make_image(side, side, 1, 16, ColorSpace::data);
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const auto texel = static_cast<std::size_t>(y * side + x);
            colors.as<float>()[texel] = (x / period + y / period) % 2 == 0 ? 0.0F : 1.0F;
            heights.as<std::uint16_t>()[texel] = static_cast<std::uint16_t>(x * 37 + y * 5);
        }
    }
    Material material;
    material.name = "relief";
    material.unlit = true;
    material.diffuse = glm::vec3(1.0F);
    material.diffuse_texture = Texture{0};
    material.height_map.emplace().texture = Texture{1};
    Scene scene = test::square_scene(material);
    scene.images = {{"colors", colors}, {"heights", heights}};
    const double angle = glm::radians(degrees);
    Camera camera;
    camera.world_from_view =
        glm::mat4(glm::inverse(glm::lookAt(6.0 * glm::dvec3(0.0, -std::sin(angle), std::cos(angle)),
                                           glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 1e-9))));
    camera.orthographic_height = 4.0F;
    scene.camera = camera;
    return scene;
}

}  // namespace

/// A shift of d pixels moves a lookup by d times the texels of a pixel, and between the centers of
/// neighboring texels a texture changes by their contrast at most. The sharpest texture, one of
/// black and white texels, comes close to that: so a bound of n pixels allows changes of n times
/// the texels of a pixel in linear radiance, and no fixed bound keeps every picture within 1 of
/// 255. Where a pixel has at most one texel, 1/255 does.
TEST_F(ReliefBoundTest, ChangesByTheBoundTimesTheContrastOfTexels) {
    constexpr int pixels = 128;
    constexpr double texels_of_pixel = 32.0 / pixels;
    for (const double degrees : {30.0, 60.0, 75.0}) {
        for (const float bound : bounds_measured) {
            FrameSettings settings{.width = pixels, .height = pixels, .samples = 1};
            settings.output = OutputCoding::linear;
            Scene scene = checkerboard(degrees, 1);
            settings.camera = scene.camera;
            scene = just_below(scene, bound, settings);
            const Change change = left_out(scene, settings);
            const double contrast =
                texels_of_pixel / std::cos(glm::radians(degrees)) * static_cast<double>(bound);
            // Graphics processors filter in steps of 1/256 of a texel.
            constexpr double step = 1.0 / 256.0;
            EXPECT_LE(change.largest, contrast + step) << degrees << ", " << bound;
            EXPECT_GE(change.largest, 0.5 * contrast - step) << degrees << ", " << bound;
            if (bound <= 1.0F / 255.0F) {
                EXPECT_LE(change.largest, 1.0 / 255.0) << degrees;
            }
        }
    }
}

/// The scenes of data/ with reliefs of bricks: a pixel changes by the bound times the whole range
/// of codes at most, the contrast of an edge that is as sharp as a pixel. Lookups at displaced
/// coordinates have explicit derivatives, for which the level of detail is rounded differently.
TEST_LABELS(slow);
TEST_F(ReliefBoundTest, ChangesFewCodesOfTheSampleScenes) {
    FrameSettings settings{.width = 240, .height = 135, .samples = 1};
    constexpr double of_programs = 4.0;
    std::array<Change, bounds_measured.size()> most{};
    int scenes = 0;
    int unchanged = 0;  // By more than 1 code, at 0.05 pixels.
    for (const auto& [name, sample] : sample_scenes()) {
        SCOPED_TRACE(name);
        settings.camera = sample.camera;
        if (shift_of(sample, settings) == 0.0) continue;
        ++scenes;
        for (std::size_t i = 0; i < bounds_measured.size(); ++i) {
            const Scene scene = just_below(sample, bounds_measured.at(i), settings);
            const Change change = left_out(scene, settings);
            if (bounds_measured.at(i) == 0.05F && change.largest <= 1.0) ++unchanged;
            most.at(i).largest = std::max(most.at(i).largest, change.largest);
            most.at(i).above = std::max(most.at(i).above, change.above);
        }
    }
    EXPECT_EQ(scenes, 12);
    EXPECT_GE(unchanged, 8);
    for (std::size_t i = 0; i < bounds_measured.size(); ++i) {
        const double bound = static_cast<double>(bounds_measured.at(i));
        EXPECT_LE(most.at(i).largest, 255.0 * bound + of_programs) << bound;
        EXPECT_GE(most.at(i).largest, 100.0 * bound) << bound;
        EXPECT_LE(most.at(i).above, 0.5 * bound + 0.003) << bound;
    }
}

/// The bound is that of all effects of a relief, and 0 plans them for every relief with a depth.
TEST_F(ReliefBoundTest, DecidesAboutAllEffectsOfARelief) {
    const FrameSettings at{.width = 128, .height = 128, .samples = 1};
    Scene scene = checkerboard(60.0, 1);
    scene.materials[0].unlit = false;
    FrameSettings settings = at;
    settings.camera = scene.camera;
    DirectionalLight light;
    light.direction_world = {0.7F, 0.0F, -0.7F};
    scene.directional_lights = {light};
    ReliefMap& map = *scene.materials[0].height_map;
    map.texture.wrap_u = map.texture.wrap_v = Wrap::clamp;
    map.self_shadow = map.write_depth = true;
    map.silhouette = ReliefSilhouette::clip;
    map.depth = 0.02F;  // 0.08 pixels deep.
    const auto reason_of = [&](const std::string& effect) {
        const FramePlan plan = plan_effects(scene, settings);
        for (const EffectReason& reason : plan.draws.at(0).reasons) {
            if (reason.effect == effect) return reason;
        }
        return EffectReason{};
    };
    for (const char* effect :
         {"maximum mipmaps", "self-shadow", "clipped relief", "written depth"}) {
        SCOPED_TRACE(effect);
        map.bound = 0.5F;
        EXPECT_FALSE(reason_of(effect).on);
        EXPECT_THAT(reason_of(effect).reason, HasSubstr("less than 0.5"));
        map.bound = 0.1F;
        EXPECT_FALSE(reason_of(effect).on);
        EXPECT_THAT(reason_of(effect).reason, HasSubstr("less than 0.1"));
        map.bound = 0.02F;
        EXPECT_TRUE(reason_of(effect).on);
        map.bound = 0.0F;
        map.depth = 1e-6F;
        EXPECT_TRUE(reason_of(effect).on);
        map.depth = 0.0F;
        EXPECT_FALSE(reason_of(effect).on);
        map.depth = 0.02F;
    }
}

}  // namespace relief
