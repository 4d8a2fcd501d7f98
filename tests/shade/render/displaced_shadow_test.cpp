// SPDX-License-Identifier: Apache-2.0
// Shadow maps that hold the depth of reliefs: closed forms of what casts and what receives a
// shadow, OpenGL against the reference, and surfaces that must not shade themselves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <utility>
#include <vector>

#include "relief/shade/effects.h"
#include "relief/shade/reference.h"
#include "relief/shade/renderer.h"
#include "shade/render/draw_support.h"
#include "shade/render/relief_scenes.h"
#include "support/sanitized.h"

namespace relief {
using namespace relief::shade;

namespace {

using testing::HasSubstr;

constexpr int shadow_pixels = 160;
constexpr double pixels_per_unit = shadow_pixels / 4.0;
/// An edge that runs along a column of pixels is on either side of it, by a texel of a shadow map.
constexpr double one_column = 1.2 / shadow_pixels;

Material gray_material() {
    Material material;
    material.diffuse = glm::vec3(0.8F);
    material.ambient = glm::vec3(0.2F);
    material.double_sided = true;
    return material;
}

/// A square ground with a relief that writes its depth, in a light that casts a hard shadow.
Scene ground(const Image& heights, const Camera& camera, float depth) {
    Material material = gray_material();
    material.name = "ground";
    ReliefMap& map = material.height_map.emplace();
    map.texture = Texture{0};
    map.depth = depth;
    map.write_depth = true;
    Scene scene = test::square_scene(material);
    scene.images = {{"heights", heights}};
    scene.ambient = glm::vec3(0.5F);
    scene.camera = camera;
    scene.shadow.emplace().size = 0.0F;
    return scene;
}

/// Adds a square of the size 4 with a material, which a matrix transforms.
void add_square(Scene& scene, const Material& material, const glm::mat4& world_from_object) {
    Mesh mesh = test::facing_square();
    mesh.material_ranges = {{0, static_cast<std::uint32_t>(mesh.triangles.size()),
                             static_cast<std::uint32_t>(scene.materials.size())}};
    scene.instances.push_back(
        {static_cast<std::uint32_t>(scene.meshes.size()), world_from_object, "square"});
    scene.meshes.push_back(std::move(mesh));
    scene.materials.push_back(material);
}

/// A wall along the y axis at an x, from z = -1 to z = 1.
Scene with_wall(Scene scene, float x) {
    const glm::mat4 upright =
        glm::translate(glm::mat4(1.0F), {x, 0.0F, 0.0F}) *
        glm::rotate(glm::mat4(1.0F), glm::radians(90.0F), {0.0F, 1.0F, 0.0F}) *
        glm::scale(glm::mat4(1.0F), {0.5F, 1.0F, 1.0F});
    add_square(scene, gray_material(), upright);
    return scene;
}

EffectReason shadow_reason(const Scene& scene) {
    const FramePlan plan = plan_effects(
        scene,
        {.width = shadow_pixels, .height = shadow_pixels, .samples = 1, .camera = scene.camera});
    for (const EffectReason& reason : plan.draws.at(0).reasons) {
        if (reason.effect == "displaced shadow") return reason;
    }
    return {};
}

class DisplacedShadows : public test::DrawTest {
  protected:
    /// Linear radiance.
    [[nodiscard]] Image drawn(const Scene& scene, const EffectRequest& request = {}) const {
        FrameSettings settings{
            .width = shadow_pixels, .height = shadow_pixels, .samples = 1, .camera = scene.camera};
        settings.output = OutputCoding::linear;
        const FramePlan plan =
            force_effects(scene, settings, plan_effects(scene, settings), request);
        return render(scene, plan, settings).image;
    }
    /// Compares OpenGL with the reference, where rounding does not decide a pixel.
    /// \return the share of pixels that differ by more than 1/16 of what light adds
    [[nodiscard]] double differing(const Scene& scene) const {
        const Image picture = drawn(scene);
        const Reference reference =
            render_reference(scene, {.width = shadow_pixels, .height = shadow_pixels});
        int compared = 0;
        int different = 0;
        for (int y = 0; y < shadow_pixels; ++y) {
            for (int x = 0; x < shadow_pixels; ++x) {
                if (test::pixel(reference.edges, x, y)[0] > 0.0) continue;
                ++compared;
                const double apart = std::abs(test::pixel(picture, x, y)[0] -
                                              test::pixel(reference.radiance, x, y)[0]);
                different += apart > 0.02 ? 1 : 0;
            }
        }
        EXPECT_GT(compared, shadow_pixels * shadow_pixels / 3);
        return static_cast<double>(different) / std::max(compared, 1);
    }
};

/// The first and the last dark pixel of a row, as coordinates of their outer borders.
glm::dvec2 dark_interval(const Image& image, int row) {
    glm::dvec2 interval(0.0);
    bool is_found = false;
    for (int x = 0; x < image.width; ++x) {
        if (test::pixel(image, x, row)[0] > 0.11) continue;
        if (!is_found) interval.x = x;
        interval.y = x + 1;
        is_found = true;
    }
    return interval / pixels_per_unit - 2.0;
}

/// Returns how many pixels are darker in a picture than in another one.
int darkened(const Image& image, const Image& other) {
    int count = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x)
            count += test::pixel(image, x, y)[0] < test::pixel(other, x, y)[0] - 0.005 ? 1 : 0;
    }
    return count;
}

}  // namespace

/// Black heights are a plane at z = -d. Seen from straight above, the shadow of a wall of the
/// height 1 ends at (1 + d) tan(a) from it, and at tan(a) on the flat surface.
TEST_F(DisplacedShadows, OfAWallEndFartherOnADeepGround) {
    constexpr float depth = 8.0F;
    constexpr double d = static_cast<double>(depth) * test::relief_texel;
    for (const double degrees : {30.0, 45.0, 60.0}) {
        SCOPED_TRACE(degrees);
        const double tangent = std::tan(glm::radians(degrees));
        Scene scene =
            with_wall(ground(test::black_heights(), test::parallel_camera(0.0), depth), -1.5F);
        scene.directional_lights = {test::light_from_the_left(degrees)};
        EXPECT_TRUE(shadow_reason(scene).on);
        EXPECT_THAT(shadow_reason(scene).reason,
                    HasSubstr("meets the relief of material 'ground'"));
        for (const int row : {20, 80, 140}) {
            const glm::dvec2 shadow = dark_interval(drawn(scene), row);
            EXPECT_NEAR(shadow.y, -1.5 + (1.0 + d) * tangent, 1.0 / pixels_per_unit);
        }
        EXPECT_LT(differing(scene), one_column);
        scene.materials[0].height_map->write_depth = false;
        EXPECT_NEAR(dark_interval(drawn(scene), 80).y, -1.5 + tangent, 1.0 / pixels_per_unit);
        EXPECT_LT(differing(scene), one_column);
    }
}

/// A plate with black heights above the ground. Light that leaves its map before it meets the
/// relief passes, so that its shadow is shorter by d tan(a) if its silhouette is clipped.
TEST_F(DisplacedShadows, OfAPlateAreClippedAsTheLightSeesIt) {
    constexpr float depth = 8.0F;
    constexpr double d =
        static_cast<double>(depth) / test::relief_map_side;  // The plate is 1 wide.
    constexpr float above = 1.4F;
    Scene scene = ground(test::black_heights(), test::parallel_camera(0.0), depth);
    Material plate = scene.materials[0];
    plate.name = "plate";
    plate.height_map->texture.wrap_u = plate.height_map->texture.wrap_v = Wrap::clamp;
    scene.materials[0] = gray_material();
    scene.directional_lights = {test::light_from_the_left(60.0)};
    add_square(scene, plate,
               glm::translate(glm::mat4(1.0F), {-1.0F, 0.0F, above}) *
                   glm::scale(glm::mat4(1.0F), glm::vec3(0.25F)));
    const double tangent = std::tan(glm::radians(60.0));
    const double left = -1.5 + static_cast<double>(above) * tangent;
    const glm::dvec2 whole = dark_interval(drawn(scene), 80);
    EXPECT_NEAR(whole.x, left, 1.0 / pixels_per_unit);
    EXPECT_NEAR(whole.y, left + 1.0, 1.0 / pixels_per_unit);
    EXPECT_LT(differing(scene), one_column);
    scene.materials[1].height_map->silhouette = ReliefSilhouette::clip;
    const glm::dvec2 clipped = dark_interval(drawn(scene), 80);
    EXPECT_NEAR(clipped.x, left, 1.0 / pixels_per_unit);
    EXPECT_NEAR(clipped.y, left + 1.0 - d * tangent, 1.0 / pixels_per_unit);
    EXPECT_LT(differing(scene), one_column);
}

/// A relief casts a shadow on itself through the map, too: a wall of texels, as long as a tangent.
TEST_F(DisplacedShadows, OfAReliefFallOnItself) {
    constexpr int floor = 16;
    constexpr float depth = 12.0F;
    for (const double degrees : {45.0, 60.0}) {
        Scene scene = ground(test::wall_heights(floor), test::parallel_camera(0.0), depth);
        scene.materials[0].height_map->texture.wrap_u = Wrap::clamp;
        scene.directional_lights = {test::light_from_the_left(degrees)};
        // It begins at the upper edge of the flank, at the center of the last texel of the wall.
        const double begin = (floor - 0.5) * test::relief_texel - 2.0;
        const double end = begin + static_cast<double>(depth) * test::relief_texel *
                                       std::tan(glm::radians(degrees));
        const glm::dvec2 shadow = dark_interval(drawn(scene), 80);
        EXPECT_NEAR(shadow.y, end, 1.5 / pixels_per_unit) << degrees;
        EXPECT_LT(differing(scene), 0.01) << degrees;
    }
}

TEST_F(DisplacedShadows, AreThoseOfTheReference) {
    PointLight point;
    point.position_world = {-4.0F, 1.0F, 4.0F};
    point.intensity = glm::vec3(30.0F);
    SpotLight spot;
    spot.point.position_world = {-3.0F, -3.0F, 4.5F};
    spot.point.intensity = glm::vec3(30.0F);
    spot.direction_world = {0.55F, 0.55F, -0.8F};
    spot.outer_cone = 0.7F;
    const auto sun = [](Scene& s) { s.directional_lights = {test::light_from_the_left(50.0)}; };
    const auto soft = [](Scene& s) {
        s.directional_lights = {test::light_from_the_left(50.0)};
        s.shadow->size = glm::radians(4.0F);
    };
    const auto at_point = [&](Scene& s) { s.point_lights = {point}; };
    const auto at_spot = [&](Scene& s) { s.spot_lights = {spot}; };
    const auto stretched = [](Scene& s) {
        s.directional_lights = {test::light_from_the_left(50.0)};
        for (glm::vec2& texcoord : s.meshes[0].edit().texcoords)
            texcoord = glm::vec2(-1.2F, 0.7F) * texcoord;
    };
    int compared_lights = 0;
    for (const std::function<void(Scene&)>& lit :
         {std::function<void(Scene&)>(sun), {soft}, {at_point}, {at_spot}, {stretched}}) {
        if (test::is_sanitized && compared_lights++ > 0) break;
        Scene scene =
            with_wall(ground(test::bumpy_heights(), test::slanted_camera(40.0), 5.0F), -0.4F);
        scene.materials[0].bump_map = BumpMap{Texture{0}, 5.0F};
        lit(scene);
        ASSERT_TRUE(shadow_reason(scene).on);
        // The maps have texels, and the edges of shadows are as wide as one.
        const double apart = differing(scene);
        EXPECT_LT(apart, 0.03);
        RecordProperty("differing", std::to_string(apart));
        // The shadow of the flat surface is another one.
        const Image with = drawn(scene);
        const Image flat = drawn(scene, {EffectBase::planned, {{"displaced shadow", false}}});
        EXPECT_GT(darkened(with, flat) + darkened(flat, with), shadow_pixels * shadow_pixels / 100);
    }
}

/// Light that reaches every point of a relief darkens none, for all methods of the view.
TEST_F(DisplacedShadows, DoNotFallOnWhatTheLightReaches) {
    for (const HeightMethod method :
         {HeightMethod::maximum_mipmaps, HeightMethod::relief_mapping}) {
        for (const double view : {0.0, 30.0, 60.0}) {
            for (const double light : {0.0, 20.0, 40.0}) {
                Scene scene = ground(test::bumpy_heights(), test::slanted_camera(view), 2.0F);
                scene.materials[0].bump_map = BumpMap{Texture{0}, 2.0F};
                scene.materials[0].height_map->method = method;
                scene.materials[0].height_map->layers = 64;
                scene.directional_lights = {test::light_from_the_left(light)};
                const Image with = drawn(scene);
                scene.shadow.reset();
                EXPECT_EQ(darkened(with, drawn(scene)), 0)
                    << enum_name(method) << ", view " << view << ", light " << light;
            }
        }
    }
}

TEST_F(DisplacedShadows, AreLeftOutWhereNothingAsksForThem) {
    Scene scene = with_wall(ground(test::bumpy_heights(), test::slanted_camera(40.0), 5.0F), -0.4F);
    scene.materials[0].diffuse_texture = Texture{0};
    scene.directional_lights = {test::light_from_the_left(50.0)};
    const FrameSettings settings{
        .width = shadow_pixels, .height = shadow_pixels, .samples = 1, .camera = scene.camera};
    const auto names_it = [&](const Scene& shown) {
        const std::vector<ShaderListing> listings = shader_listings(plan_effects(shown, settings));
        return std::any_of(listings.begin(), listings.end(), [](const ShaderListing& listing) {
            return listing.fragment.find("shadow_from_world") != std::string::npos;
        });
    };
    EXPECT_TRUE(names_it(scene));
    const Image with = drawn(scene);
    Scene other = scene;
    other.shadow.reset();
    EXPECT_FALSE(names_it(other));
    EXPECT_THAT(shadow_reason(other).reason, HasSubstr("no light casts a shadow"));
    other = scene;
    other.materials[0].height_map->write_depth = false;
    EXPECT_FALSE(names_it(other));
    EXPECT_THAT(shadow_reason(other).reason, HasSubstr("does not request it"));
    EXPECT_FALSE(test::same_bits(drawn(other), with));
    // Far away, the depth of the relief is below the bound.
    other = scene;
    other.materials[0].height_map->depth = 0.01F;
    EXPECT_FALSE(names_it(other));
    EXPECT_THAT(shadow_reason(other).reason, HasSubstr("pixels deep, less than 0.5"));
}

}  // namespace relief
