// SPDX-License-Identifier: Apache-2.0
// The optional effects of a relief: its shadows on itself, its silhouette, its depth and its
// curvature, in OpenGL
// against the reference and against closed forms.
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

namespace relief {
using namespace relief::shade;

namespace {

using testing::HasSubstr;

constexpr int pixels = 160;

/// A gray square with a relief under a light.
Scene square(const Image& heights, const Camera& camera, float depth) {
    Material material;
    material.name = "relief";
    material.diffuse = glm::vec3(0.8F);
    material.ambient = glm::vec3(0.2F);
    ReliefMap& map = material.height_map.emplace();
    map.texture = Texture{0};
    map.texture.wrap_u = map.texture.wrap_v = Wrap::clamp;
    map.depth = depth;
    Scene scene = test::square_scene(material);
    scene.images = {{"heights", heights}};
    scene.ambient = glm::vec3(0.5F);
    scene.camera = camera;
    return scene;
}

ReliefMap& map_of(Scene& scene) {
    return *scene.materials[0].height_map;
}

FramePlan plan_of(const Scene& scene) {
    return plan_effects(scene,
                        {.width = pixels, .height = pixels, .samples = 1, .camera = scene.camera});
}

EffectReason reason_of(const Scene& scene, const std::string& effect) {
    const FramePlan plan = plan_of(scene);
    for (const EffectReason& reason : plan.draws.at(0).reasons) {
        if (reason.effect == effect) return reason;
    }
    return {};
}

class ReliefEffects : public test::DrawTest {
  protected:
    /// Linear radiance.
    [[nodiscard]] Image drawn(const Scene& scene, const EffectRequest& request = {}) const {
        FrameSettings settings{
            .width = pixels, .height = pixels, .samples = 1, .camera = scene.camera};
        settings.output = OutputCoding::linear;
        const FramePlan plan =
            force_effects(scene, settings, plan_effects(scene, settings), request);
        return render(scene, plan, settings).image;
    }
    /// Compares OpenGL with the reference, where rounding does not decide a pixel.
    /// \param compared_share  at least this share of the pixels is compared
    /// \return the share of pixels that differ by more than 2 codes
    [[nodiscard]] double differing(const Scene& scene, double compared_share = 0.33) const {
        const Image picture = drawn(scene);
        const Reference reference = render_reference(scene, {.width = pixels, .height = pixels});
        int compared = 0;
        int different = 0;
        for (int y = 0; y < pixels; ++y) {
            for (int x = 0; x < pixels; ++x) {
                if (test::pixel(reference.edges, x, y)[0] > 0.0) continue;
                ++compared;
                const glm::dvec4 apart =
                    glm::abs(test::pixel(picture, x, y) - test::pixel(reference.radiance, x, y));
                different += apart.x > 2.0 / 255.0 || apart.a > 2.0 / 255.0 ? 1 : 0;
            }
        }
        EXPECT_GT(compared, compared_share * pixels * pixels);
        return static_cast<double>(different) / std::max(compared, 1);
    }
};

/// Returns the number of pixels of a row, or of a column, that are darker than a value.
int darker(const Image& image, double value, int column, bool along_x) {
    int count = 0;
    for (int i = 0; i < image.width; ++i)
        count += test::pixel(image, along_x ? i : column, along_x ? column : i)[0] < value ? 1 : 0;
    return count;
}

}  // namespace

// Self-shadows

TEST_F(ReliefEffects, SelfShadowsAreThoseOfTheReference) {
    Scene scene = square(test::bumpy_heights(), test::slanted_camera(40.0), 5.0F);
    map_of(scene).self_shadow = true;
    PointLight point;
    point.position_world = {-1.5F, 0.4F, 0.9F};
    point.intensity = glm::vec3(2.0F);
    SpotLight spot;
    spot.point.position_world = {1.0F, 2.0F, 1.5F};
    spot.point.intensity = glm::vec3(4.0F);
    spot.direction_world = {-0.4F, -0.7F, -0.6F};
    spot.outer_cone = 0.5F;
    const auto add_sun = [](Scene& s) { s.directional_lights = {test::light_from_the_left(65.0)}; };
    const auto add_point = [&](Scene& s) { s.point_lights = {point}; };
    const auto add_spot = [&](Scene& s) { s.spot_lights = {spot}; };
    const auto add_all = [&](Scene& s) {
        s.directional_lights = {test::light_from_the_left(65.0), test::light_from_the_left(-75.0)};
        s.point_lights = {point};
        s.spot_lights = {spot};
        s.shadow.emplace();
    };
    for (const std::function<void(Scene&)>& lit :
         {std::function<void(Scene&)>(add_sun), {add_point}, {add_spot}, {add_all}}) {
        for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror}) {
            Scene changed = scene;
            lit(changed);
            map_of(changed).texture.wrap_u = map_of(changed).texture.wrap_v = wrap;
            for (glm::vec2& texcoord : changed.meshes[0].edit().texcoords)
                texcoord = 1.3F * texcoord - glm::vec2(0.2F);
            ASSERT_TRUE(reason_of(changed, "self-shadow").on);
            EXPECT_LT(differing(changed), 0.005) << enum_name(wrap);
        }
    }
    // Without them, the same scene is brighter in a good part of the picture.
    add_sun(scene);
    const Image with = drawn(scene);
    map_of(scene).self_shadow = false;
    const Image without = drawn(scene);
    int darkened = 0;
    for (int y = 0; y < pixels; ++y) {
        for (int x = 0; x < pixels; ++x) {
            const double change = test::pixel(without, x, y)[0] - test::pixel(with, x, y)[0];
            EXPECT_GE(change, 0.0);
            darkened += change > 0.05 ? 1 : 0;
        }
    }
    EXPECT_GT(darkened, pixels * pixels / 20);
}

/// Coordinates that are mirrored and stretched on the triangle, and another reflection model.
TEST_F(ReliefEffects, SelfShadowsFollowStretchedCoordinates) {
    for (const glm::vec2 scale : {glm::vec2(-1.0F, 1.0F), {1.0F, -0.5F}, {0.4F, 1.5F}}) {
        Scene scene = square(test::bumpy_heights(), test::slanted_camera(30.0), 4.0F);
        map_of(scene).self_shadow = true;
        map_of(scene).texture.wrap_u = map_of(scene).texture.wrap_v = Wrap::repeat;
        scene.materials[0].metallic_roughness.emplace().metallic = 0.0F;
        for (glm::vec2& texcoord : scene.meshes[0].edit().texcoords)
            texcoord *= scale;
        scene.directional_lights = {test::light_from_the_left(60.0)};
        EXPECT_LT(differing(scene), 0.005) << scale.x << ", " << scale.y;
    }
}

/// A wall of the height D throws a shadow of D times the tangent of the angle of light. It is seen
/// from straight above, where the relief moves nothing.
TEST_F(ReliefEffects, AWallsShadowIsAsLongAsATangent) {
    constexpr int floor = 16;
    constexpr float depth = 12.0F;
    for (const double degrees : {45.0, 60.0, 70.0}) {
        Scene scene = square(test::wall_heights(floor), test::parallel_camera(0.0), depth);
        map_of(scene).self_shadow = true;
        scene.directional_lights = {test::light_from_the_left(degrees)};
        EXPECT_THAT(reason_of(scene, "maximum mipmaps").reason, HasSubstr("shows the shadows"));
        const Image image = drawn(scene);
        // The wall's flank, between the last texel of the wall and the first one of the floor, is
        // turned away from the light, and dark. The shadow begins at its upper edge.
        const double length = static_cast<double>(depth) * (1.0 - HeightField::shadow_lift) *
                              std::tan(glm::radians(degrees));
        const double expected = length * pixels / test::relief_map_side;
        const double dark = 0.2 * 0.5 + 0.01;
        for (const int row : {10, 80, 150})
            EXPECT_NEAR(darker(image, dark, row, true), expected, 1.0) << degrees;
        EXPECT_LT(differing(scene), 0.001);
        // Half of the depth throws a shadow half as long.
        map_of(scene).depth = depth / 2;
        EXPECT_NEAR(darker(drawn(scene), dark, 80, true), expected / 2, 1.0);
    }
}

/// The second ray is exact for every method of the first one: on a wall seen from straight above,
/// all pictures are the same.
TEST_F(ReliefEffects, SelfShadowsOfAllMethodsAreExact) {
    Scene scene = square(test::wall_heights(20), test::parallel_camera(0.0), 10.0F);
    map_of(scene).self_shadow = true;
    scene.directional_lights = {test::light_from_the_left(60.0)};
    const Image exact = drawn(scene);
    for (const HeightMethod method :
         {HeightMethod::parallax, HeightMethod::parallax_occlusion, HeightMethod::relief_mapping}) {
        map_of(scene).method = method;
        EXPECT_TRUE(test::same_bits(drawn(scene), exact)) << enum_name(method);
    }
}

TEST_F(ReliefEffects, SelfShadowsAreLeftOutWhereTheyCannotShow) {
    Scene scene = square(test::bumpy_heights(), test::slanted_camera(40.0), 5.0F);
    scene.materials[0].diffuse_texture = Texture{0};
    scene.directional_lights = {test::light_from_the_left(60.0)};
    EXPECT_THAT(reason_of(scene, "self-shadow").reason, HasSubstr("does not request it"));
    const Image without = drawn(scene);
    map_of(scene).self_shadow = true;
    EXPECT_THAT(reason_of(scene, "self-shadow").reason, HasSubstr("casts shadows of at most"));
    EXPECT_FALSE(test::same_bits(drawn(scene), without));
    EXPECT_TRUE(
        test::same_bits(drawn(scene, {EffectBase::planned, {{"self-shadow", false}}}), without));
    // A texel is 2 to 3 pixels long: at 1 degree, 5 texels of depth throw a shadow of 0.2 pixels.
    scene.directional_lights = {test::light_from_the_left(1.0)};
    EXPECT_FALSE(reason_of(scene, "self-shadow").on);
    EXPECT_THAT(reason_of(scene, "self-shadow").reason, HasSubstr("on itself, less than 0.5"));
    EXPECT_TRUE(plan_of(scene).draws[0].features.depth_mapping == DepthMapping::maximum_mipmaps);
    const Image left_out = drawn(scene);
    map_of(scene).self_shadow = false;
    EXPECT_TRUE(test::same_bits(drawn(scene), left_out));
    map_of(scene).self_shadow = true;
    // Light along the surface reaches it nowhere.
    scene.directional_lights = {test::light_from_the_left(90.0)};
    EXPECT_THAT(reason_of(scene, "self-shadow").reason, HasSubstr("grazes the relief"));
    scene.directional_lights = {test::light_from_the_left(60.0)};
    map_of(scene).depth = 0.0F;
    const Features planned = plan_of(scene).draws[0].features;
    EXPECT_FALSE(planned.self_shadow);
    EXPECT_EQ(planned.depth_mapping, DepthMapping::none);
}

// Silhouettes

/// Black heights are a plane below the square. Without perspective, it is seen through the square,
/// but for the part that lies behind the edge: the depth times the tangent of the view.
TEST_F(ReliefEffects, SilhouettesEndWhereTheViewLeavesTheMap) {
    constexpr float depth = 8.0F;
    for (const double degrees : {30.0, 60.0}) {
        Scene scene = square(test::black_heights(), test::parallel_camera(degrees), depth);
        scene.camera->orthographic_height = 6.0F;
        const auto covered = [](const Image& image) {
            int count = 0;
            for (int y = 0; y < pixels; ++y)
                count += test::pixel(image, pixels / 2, y).a > 0.0 ? 1 : 0;
            return count;
        };
        const double pixels_per_texel =
            test::relief_texel * std::cos(glm::radians(degrees)) * pixels / 6.0;
        map_of(scene).silhouette = ReliefSilhouette::none;
        scene.materials[0].diffuse_texture = Texture{0};
        EXPECT_NEAR(covered(drawn(scene)), test::relief_map_side * pixels_per_texel, 1.0);
        map_of(scene).silhouette = ReliefSilhouette::clip;
        const double hidden = static_cast<double>(depth) * std::tan(glm::radians(degrees));
        EXPECT_NEAR(covered(drawn(scene)), (test::relief_map_side - hidden) * pixels_per_texel,
                    1.0);
        EXPECT_LT(differing(scene), 0.001);
        // Along an axis that repeats, nothing is clipped.
        map_of(scene).texture.wrap_v = Wrap::repeat;
        EXPECT_NEAR(covered(drawn(scene)), test::relief_map_side * pixels_per_texel, 1.0);
        map_of(scene).texture.wrap_u = Wrap::repeat;
        EXPECT_THAT(reason_of(scene, "clipped relief").reason, HasSubstr("no border"));
    }
}

TEST_F(ReliefEffects, SilhouettesAreThoseOfTheReference) {
    for (const bool unlit : {false, true}) {
        Scene scene = square(test::bumpy_heights(), test::slanted_camera(65.0), 8.0F);
        map_of(scene).silhouette = ReliefSilhouette::clip;
        scene.materials[0].diffuse_texture = Texture{0};
        scene.materials[0].unlit = unlit;
        ASSERT_TRUE(reason_of(scene, "clipped relief").on);
        EXPECT_LT(differing(scene), 0.003);
    }
}

// Depth

/// A plane through the x axis at 45 degrees, in front of the square where y > 0.
Scene with_plane(Scene scene) {
    Mesh plane = test::facing_square();
    plane.name = "plane";
    plane.material_ranges = {{0, static_cast<std::uint32_t>(plane.triangles.size()), 1}};
    for (glm::vec3& position : plane.positions)
        position.z = position.y;
    for (glm::vec3& normal : plane.normals)
        normal = glm::normalize(glm::vec3(0.0F, -1.0F, 1.0F));
    Material red;
    red.name = "plane";
    red.unlit = true;
    red.double_sided = true;
    red.diffuse = {1.0F, 0.0F, 0.0F};
    scene.meshes.push_back(std::move(plane));
    scene.materials.push_back(red);
    scene.instances.push_back({1, glm::mat4(1.0F), "plane"});
    return scene;
}

/// Black heights are a plane at z = -d, which meets the plane z = y at y = -d.
TEST_F(ReliefEffects, WrittenDepthMovesIntersections) {
    constexpr float depth = 12.0F;
    Scene scene = with_plane(square(test::black_heights(), test::parallel_camera(0.0), depth));
    const auto red_rows = [&](const Scene& shown) {
        const Image image = drawn(shown);
        int count = 0;
        for (int y = 0; y < pixels; ++y) {
            const glm::dvec4 pixel = test::pixel(image, pixels / 3, y);
            count += pixel.r > 0.9 && pixel.g < 0.1 ? 1 : 0;
        }
        return count;
    };
    EXPECT_NEAR(red_rows(scene), pixels / 2.0, 1.0);
    map_of(scene).write_depth = true;
    EXPECT_THAT(reason_of(scene, "written depth").reason, HasSubstr("pixels deep"));
    EXPECT_THAT(reason_of(scene, "maximum mipmaps").reason, HasSubstr("writes the depth"));
    const double moved = static_cast<double>(depth) * test::relief_texel;
    EXPECT_NEAR(red_rows(scene), pixels * (2.0 + moved) / 4.0, 1.0);
    EXPECT_LT(differing(scene), 0.001);
}

/// With perspective, too: on bumps, and in views of data.
TEST_F(ReliefEffects, WrittenDepthIsThatOfTheReference) {
    Scene scene = with_plane(square(test::bumpy_heights(), test::slanted_camera(50.0), 10.0F));
    scene.materials[0].diffuse_texture = Texture{0};
    scene.directional_lights = {test::light_from_the_left(30.0)};
    const Image flat = drawn(scene);
    map_of(scene).write_depth = true;
    EXPECT_LT(differing(scene), 0.003);
    EXPECT_FALSE(test::same_bits(drawn(scene), flat));
    EXPECT_TRUE(
        test::same_bits(drawn(scene, {EffectBase::planned, {{"written depth", false}}}), flat));
    // Far away, a relief of less than half a pixel is flat.
    scene.camera->world_from_view =
        glm::translate(glm::mat4(1.0F), {0.0F, 0.0F, 800.0F}) * glm::mat4(1.0F);
    scene.camera->far = 2000.0F;
    EXPECT_FALSE(reason_of(scene, "written depth").on);
    EXPECT_THAT(reason_of(scene, "written depth").reason, HasSubstr("deep, less than 0.5"));
}

// Curvature

/// A cylinder of radius 1 around the y axis, 3 long. The map repeats 4 times around it, upright,
/// and its texels are squares.
Mesh upright_cylinder() {
    constexpr int around = 64;
    const double turn = 2.0 * 3.141592653589793;
    Mesh mesh;
    for (int i = 0; i <= around; ++i) {
        for (const double y : {1.5, -1.5}) {
            const double angle = turn * i / around;
            mesh.normals.emplace_back(std::sin(angle), 0.0, std::cos(angle));
            mesh.positions.emplace_back(std::sin(angle), y, std::cos(angle));
            mesh.texcoords.emplace_back(4.0 * i / around, (1.5 - y) * 4.0 / turn);
        }
    }
    for (std::uint32_t i = 0; i < 2 * around; i += 2) {
        mesh.triangles.emplace_back(i, i + 1, i + 3);
        mesh.triangles.emplace_back(i, i + 3, i + 2);
    }
    mesh.material_ranges = {{0, static_cast<std::uint32_t>(mesh.triangles.size()), 0}};
    return mesh;
}

constexpr double cylinder_texel = 2.0 * 3.141592653589793 / (4.0 * test::relief_map_side);

/// The relief around the cylinder, which curves.
Scene around_cylinder(const Image& heights, const Camera& camera, float depth) {
    Scene scene = square(heights, camera, depth);
    scene.meshes[0] = upright_cylinder();
    map_of(scene).texture.wrap_u = map_of(scene).texture.wrap_v = Wrap::repeat;
    map_of(scene).silhouette = ReliefSilhouette::curve;
    scene.materials[0].diffuse_texture = Texture{0};
    scene.materials[0].ambient = glm::vec3(1.0F);
    scene.ambient = glm::vec3(1.0F);
    return scene;
}

int covered_in_row(const Image& image, int row) {
    int count = 0;
    for (int x = 0; x < image.width; ++x)
        count += test::pixel(image, x, row).a > 0.0 ? 1 : 0;
    return count;
}

/// A constant height is a thinner cylinder, whose outline every method shows.
TEST_F(ReliefEffects, TheOutlineOfACylinderIsThatOfItsRelief) {
    constexpr float depth = 8.0F;
    constexpr double pixels_per_unit = pixels / 2.4;
    for (const double height : {0.0, 0.5}) {
        Camera camera = test::parallel_camera(0.0);
        camera.orthographic_height = 2.4F;
        Scene scene =
            around_cylinder(test::heights_by([&](int, int) { return height; }), camera, depth);
        ASSERT_TRUE(reason_of(scene, "curved relief").on);
        const double radius = 1.0 - static_cast<double>(depth) * (1.0 - height) * cylinder_texel;
        for (const HeightMethod method :
             {HeightMethod::maximum_mipmaps, HeightMethod::parallax,
              HeightMethod::parallax_occlusion, HeightMethod::relief_mapping}) {
            map_of(scene).method = method;
            const Image image = drawn(scene);
            for (const int row : {20, 80, 150})
                EXPECT_NEAR(covered_in_row(image, row), 2.0 * radius * pixels_per_unit, 1.5)
                    << enum_name(method) << ", height " << height;
        }
        map_of(scene).method = HeightMethod::maximum_mipmaps;
        EXPECT_LT(differing(scene, 0.15), 0.002);
        map_of(scene).silhouette = ReliefSilhouette::none;
        EXPECT_NEAR(covered_in_row(drawn(scene), 80), 2.0 * pixels_per_unit, 1.5);
    }
}

/// On bumps: around a cylinder and over a sphere, with shadows, depth, borders, perspective, and
/// coordinates that are mirrored and stretched.
TEST_F(ReliefEffects, CurvedReliefsAreThoseOfTheReference) {
    Camera camera = test::slanted_camera(25.0);
    camera.vertical_fov = 0.45F;
    const Scene cylinder = around_cylinder(test::bumpy_heights(), camera, 6.0F);
    Scene with_effects = cylinder;
    map_of(with_effects).write_depth = true;
    map_of(with_effects).self_shadow = true;
    with_effects.directional_lights = {test::light_from_the_left(40.0)};
    Scene with_border = cylinder;
    map_of(with_border).texture.wrap_v = Wrap::clamp;
    Scene stretched = cylinder;
    for (glm::vec2& texcoord : stretched.meshes[0].edit().texcoords)
        texcoord *= glm::vec2(-0.6F, 1.4F);
    Scene sphere = cylinder;
    Mesh round = test::sphere(48, 24);
    round.material_ranges = {{0, static_cast<std::uint32_t>(round.triangles.size()), 0}};
    sphere.meshes[0] = round;
    for (glm::vec2& texcoord : sphere.meshes[0].edit().texcoords)
        texcoord *= glm::vec2(4.0F, 2.0F);
    for (const Scene& scene : {cylinder, with_effects, with_border, stretched, sphere}) {
        ASSERT_TRUE(reason_of(scene, "curved relief").on);
        Scene flat = scene;
        map_of(flat).silhouette = ReliefSilhouette::clip;
        // Rounding in float decides more of the hits than on the plane: near the outline, rays pass
        // closely over bumps.
        EXPECT_LT(differing(scene), 0.002 + 1.8 * differing(flat));
        EXPECT_FALSE(test::same_bits(drawn(flat), drawn(scene)));
    }
}

/// Light passes over the relief to the far side of the mesh, which is not displaced, so that the
/// outline of the shadow stays that of the mesh: at 45 degrees, it ends at 2 + sqrt(2) on a plane 2
/// behind the axis.
TEST_F(ReliefEffects, CurvedReliefsCastTheShadowOfTheirMesh) {
    constexpr double pixels_per_unit = pixels / 8.0;
    Camera camera = test::parallel_camera(0.0);
    camera.orthographic_height = 8.0F;
    Scene scene = with_plane(around_cylinder(test::black_heights(), camera, 8.0F));
    Mesh& plane = scene.meshes[1].edit();
    for (glm::vec3& position : plane.positions)
        position = {2.0F * position.x, 2.0F * position.y, -2.0F};
    plane.normals.assign(plane.positions.size(), {0.0F, 0.0F, 1.0F});
    scene.materials[1].unlit = false;
    scene.directional_lights = {test::light_from_the_left(45.0)};
    scene.shadow.emplace().size = 0.0F;
    const auto end_of_shadow = [&](const Image& image) {
        int end = pixels;
        while (end > 0 && test::pixel(image, end - 1, pixels / 2).r > 1.2)
            --end;
        return (end - pixels / 2) / pixels_per_unit;
    };
    for (const bool write_depth : {false, true}) {
        map_of(scene).write_depth = write_depth;
        EXPECT_EQ(reason_of(scene, "displaced shadow").on, write_depth);
        ASSERT_TRUE(reason_of(scene, "curved relief").on);
        const Reference reference = render_reference(scene, {.width = pixels, .height = pixels});
        for (const Image& image : {drawn(scene), reference.radiance})
            EXPECT_NEAR(end_of_shadow(image), 2.0 + std::sqrt(2.0), 1.5 / pixels_per_unit);
    }
}

/// A plane in front of a part of the cylinder hides its relief where |x| > sqrt(r^2 - z^2).
TEST_F(ReliefEffects, CurvedReliefsWriteTheDepthOfTheCylinder) {
    constexpr float depth = 6.0F;
    Camera camera = test::parallel_camera(0.0);
    camera.orthographic_height = 2.4F;
    Scene scene = with_plane(around_cylinder(test::black_heights(), camera, depth));
    constexpr double z = 0.2;
    for (glm::vec3& position : scene.meshes[1].edit().positions)
        position.z = static_cast<float>(z);
    for (glm::vec3& normal : scene.meshes[1].edit().normals)
        normal = {0.0F, 0.0F, 1.0F};
    map_of(scene).write_depth = true;
    const auto relief_pixels = [&] {
        const Image image = drawn(scene);
        int count = 0;
        for (int x = 0; x < pixels; ++x)
            count += test::pixel(image, x, 80).r < 0.9 ? 1 : 0;
        return count;
    };
    const double radius = 1.0 - static_cast<double>(depth) * cylinder_texel;
    const double expected = 2.0 * std::sqrt(radius * radius - z * z) * pixels / 2.4;
    EXPECT_NEAR(relief_pixels(), expected, 2.0);
    EXPECT_LT(differing(scene, 0.15), 0.002);
    // The depth of a relief on the plane is that of black also where the surface falls away.
    map_of(scene).silhouette = ReliefSilhouette::none;
    EXPECT_GT(std::abs(relief_pixels() - expected), 3.0);
}

TEST_F(ReliefEffects, CurvatureIsLeftOutWhereItCannotShow) {
    Scene flat = square(test::bumpy_heights(), test::slanted_camera(50.0), 6.0F);
    flat.materials[0].diffuse_texture = Texture{0};
    map_of(flat).texture.wrap_u = map_of(flat).texture.wrap_v = Wrap::repeat;
    const Image without = drawn(flat);
    EXPECT_THAT(reason_of(flat, "curved relief").reason, HasSubstr("does not request it"));
    map_of(flat).silhouette = ReliefSilhouette::curve;
    EXPECT_THAT(reason_of(flat, "curved relief").reason, HasSubstr("covers flat triangles only"));
    EXPECT_TRUE(test::same_bits(drawn(flat), without));
    // Requested by name, it changes no pixel there.
    EXPECT_TRUE(
        test::same_bits(drawn(flat, {EffectBase::planned, {{"curved relief", true}}}), without));

    Camera camera = test::parallel_camera(0.0);
    Scene scene = around_cylinder(test::bumpy_heights(), camera, 6.0F);
    EXPECT_THAT(reason_of(scene, "curved relief").reason, HasSubstr("the curvature moves"));
    const Image curved = drawn(scene);
    const Image off = drawn(scene, {EffectBase::planned, {{"curved relief", false}}});
    EXPECT_FALSE(test::same_bits(curved, off));
    map_of(scene).silhouette = ReliefSilhouette::none;
    EXPECT_TRUE(test::same_bits(drawn(scene), off));
    map_of(scene).silhouette = ReliefSilhouette::curve;
    // Half a pixel of depth: a texel is 1.6 pixels wide at a height of 2.4.
    scene.camera->orthographic_height = 60.0F;
    EXPECT_FALSE(reason_of(scene, "curved relief").on);
    EXPECT_THAT(reason_of(scene, "curved relief").reason, HasSubstr("less than 0.5"));
}

}  // namespace relief
