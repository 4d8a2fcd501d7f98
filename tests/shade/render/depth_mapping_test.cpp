// SPDX-License-Identifier: Apache-2.0
// Relief mapping: OpenGL's picture of every method against the exact hits of the reference, the
// levels of maxima, and the bound below which a relief is left out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <string>
#include <vector>

#include "relief/mesh/image_file.h"
#include "relief/shade/effects.h"
#include "relief/shade/image_compare.h"
#include "relief/shade/reference.h"
#include "relief/shade/renderer.h"
#include "render/textures.h"
#include "shade/render/draw_support.h"
#include "support/labels.h"
#include "support/sanitized.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::shade;

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr int relief_side = 192;

/// A camera that looks at the origin at an angle from the z axis, from below.
Camera camera_at(double degrees, double distance = 6.0) {
    const double angle = glm::radians(degrees);
    const glm::dvec3 eye(0.0, -distance * std::sin(angle), distance * std::cos(angle));
    Camera camera;
    camera.world_from_view =
        glm::mat4(glm::inverse(glm::lookAt(eye, glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 1e-9))));
    camera.vertical_fov = 0.6F;
    return camera;
}

Image heights_of_bricks() {
    return read_image(test::source_directory() / "data/bricks-height.png", ImageUse::data);
}

/// Hills, smooth and without a period.
Image hills(int width, int height) {
    Image image = make_image(width, height, 1, 16, ColorSpace::data);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double value = 0.5 + 0.25 * std::sin(0.31 * x + 0.11 * y) +
                                 0.25 * std::sin(0.17 * y - 0.23 * x + 1.0);
            image.as<std::uint16_t>()[static_cast<std::size_t>(y * width + x)] =
                static_cast<std::uint16_t>(65535.0 * value);
        }
    }
    return image;
}

/// A cone map of narrow cones, which hold all of the space above the heights.
Image narrow_cones(const Image& heights) {
    const int side = heights.width;
    const auto at = [&](int x, int y) {
        const int column = (x % side + side) % side;
        const int row = (y % side + side) % side;
        return heights.as<std::uint16_t>()[static_cast<std::size_t>(row * side + column)] / 65535.0;
    };
    Image cones = make_image(side, side, 2, 32, ColorSpace::data);
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            double ratio = 1.0;
            for (int down = -side; down <= side; ++down) {
                for (int right = -side; right <= side; ++right) {
                    const double higher = at(x + right, y + down) - at(x, y);
                    // Nearer, because heights and cones are filtered.
                    const double apart = 0.7 * std::hypot(right, down) / side;
                    if (higher > 0.0) ratio = std::min(ratio, apart / higher);
                }
            }
            const auto texel = 2 * static_cast<std::size_t>(y * side + x);
            cones.as<float>()[texel] = static_cast<float>(at(x, y));
            cones.as<float>()[texel + 1] = static_cast<float>(std::sqrt(ratio));
        }
    }
    return cones;
}

/// A square whose heights displace its colors and normals; the colors are the heights.
Scene relief_scene(const Image& heights, const Camera& camera, float depth,
                   Wrap wrap = Wrap::repeat) {
    Texture texture{0};
    texture.wrap_u = texture.wrap_v = wrap;
    Material material;
    material.name = "relief";
    material.diffuse = glm::vec3(1.0F);
    material.ambient = glm::vec3(1.0F);
    material.diffuse_texture = texture;
    material.height_map.emplace();
    material.height_map->texture = texture;
    material.height_map->depth = depth;
    Scene scene = test::square_scene(material);
    scene.images = {{"heights", heights}};
    scene.ambient = glm::vec3(0.9F);
    scene.camera = camera;
    return scene;
}

/// Scales the texture coordinates of the square; negative factors mirror them.
Scene with_texcoords(Scene scene, const glm::vec2& scale, const glm::vec2& begin = {0.0F, 0.0F}) {
    for (glm::vec2& texcoord : scene.meshes[0].edit().texcoords)
        texcoord = begin + scale * texcoord;
    return scene;
}

Image as_codes(const Image& picture) {
    Image codes = make_image(picture.width, picture.height, 4, 8, ColorSpace::srgb);
    const auto values = picture.as<float>();
    for (std::size_t i = 0; i < values.size(); ++i)
        codes.as<std::uint8_t>()[i] = static_cast<std::uint8_t>(255.0F * values[i] + 0.5F);
    return codes;
}

/// What OpenGL's picture is off the reference.
struct Apart {
    double mean = 0.0;       ///< In codes, over all pixels that rounding does not decide.
    double differing = 0.0;  ///< The share of them that is off by more than 2 codes.
    double flip = 0.0;       ///< Over all pixels.
    int compared = 0;
};

class DepthMapped : public test::DrawTest {
  protected:
    [[nodiscard]] Apart apart(const Scene& scene, const Reference& reference,
                              int pixels = relief_side) const {
        const FrameSettings settings{.width = pixels, .height = pixels, .samples = 1};
        const Image expected =
            as_codes(reference_picture(reference.radiance, scene, OutputCoding::srgb));
        const Image drawn = render(scene, settings).image;
        Apart result;
        result.flip = flip_difference(drawn, expected).mean;
        for (int y = 0; y < pixels; ++y) {
            for (int x = 0; x < pixels; ++x) {
                if (test::pixel(reference.edges, x, y)[0] > 0.0) continue;
                ++result.compared;
                const double codes =
                    std::abs(test::pixel(drawn, x, y)[0] - test::pixel(expected, x, y)[0]);
                result.mean += codes;
                result.differing += codes > 2.0 ? 1.0 : 0.0;
            }
        }
        result.mean /= std::max(result.compared, 1);
        result.differing /= std::max(result.compared, 1);
        return result;
    }
    [[nodiscard]] Apart apart(const Scene& scene) const {
        return apart(scene, reference_of(scene));
    }
    [[nodiscard]] static Reference reference_of(const Scene& scene, int pixels = relief_side) {
        return render_reference(scene, {.width = pixels, .height = pixels});
    }
    [[nodiscard]] Image picture(const Scene& scene, const EffectRequest& request = {}) const {
        const FrameSettings settings{
            .width = relief_side, .height = relief_side, .samples = 1, .camera = scene.camera};
        const FramePlan plan = plan_effects(scene, settings);
        return render(scene, force_effects(scene, settings, plan, request), settings).image;
    }
};

/// The reason of maximum mipmaps in the plan for the scene's camera.
EffectReason planned(const Scene& scene, int pixels = relief_side) {
    const FramePlan plan = plan_effects(
        scene, {.width = pixels, .height = pixels, .samples = 1, .camera = scene.camera});
    for (const EffectReason& reason : plan.draws.at(0).reasons) {
        if (reason.effect == "maximum mipmaps") return reason;
    }
    return {};
}

}  // namespace

/// Maximum mipmaps find the exact hits, for all ways in which a map continues and is stretched.
TEST_F(DepthMapped, MaximumMipmapsShowTheExactHits) {
    constexpr int pixels = 144;
    struct Case {
        const char* name;
        int width;
        int height;
        Wrap wrap;
        glm::vec2 scale;
        glm::vec2 begin;
    };
    for (const Case& c : {Case{"repeated", 64, 64, Wrap::repeat, {1, 1}, {0.3F, 0.6F}},
                          Case{"odd size", 37, 53, Wrap::repeat, {1, 1}, {-3.3F, 0.6F}},
                          Case{"clamped", 37, 53, Wrap::clamp, {2, 2}, {-0.5F, -0.5F}},
                          Case{"mirrored", 37, 53, Wrap::mirror, {1.5F, 1.5F}, {-0.7F, -0.6F}},
                          Case{"stretched", 64, 64, Wrap::repeat, {1.5F, 0.5F}, {0, 0}},
                          Case{"reversed", 64, 64, Wrap::repeat, {-1, 1}, {0.2F, 0}},
                          Case{"upside down", 64, 64, Wrap::repeat, {1, -1}, {0.2F, 0}},
                          Case{"one row", 64, 1, Wrap::repeat, {1, 1}, {0, 0}},
                          Case{"one texel", 1, 1, Wrap::repeat, {1, 1}, {0, 0}}}) {
        for (const double degrees : {0.0, 30.0, 60.0}) {
            if (test::is_sanitized && degrees != 60.0) continue;
            SCOPED_TRACE(testing::Message() << c.name << ", " << degrees << " degrees");
            const Scene scene = with_texcoords(
                relief_scene(hills(c.width, c.height), camera_at(degrees), 6.0F, c.wrap), c.scale,
                c.begin);
            const Apart found = apart(scene, reference_of(scene, pixels), pixels);
            EXPECT_GT(found.compared, pixels * pixels / 8);
            // Derivatives of coordinates in float: 1e-3 of the displacement.
            EXPECT_LT(found.mean, 0.5);
            EXPECT_LT(found.differing, 0.005);
        }
    }
}

/// Two charts that meet at y = 0, between the eye below and what it sees behind. Each half of the
/// square shows what its own coordinates would show on the whole square: a ray that crosses the
/// border continues in the map of the chart in which it began. So there is no seam where the map
/// continues with the heights of the other chart.
TEST_F(DepthMapped, RaysCrossSeamsInTheMapOfTheirChart) {
    using Coordinates = glm::vec2 (*)(const glm::vec2& texcoord);
    const auto with_charts = [](Scene scene, Coordinates near, Coordinates far) {
        Mesh mesh = scene.meshes[0];
        const Mesh half = mesh;
        mesh.positions.insert(mesh.positions.end(), half.positions.begin(), half.positions.end());
        mesh.normals.insert(mesh.normals.end(), half.normals.begin(), half.normals.end());
        mesh.texcoords.resize(mesh.positions.size());
        mesh.tangents.clear();
        for (const glm::uvec3& triangle : half.triangles)
            mesh.triangles.push_back(triangle + static_cast<std::uint32_t>(half.positions.size()));
        mesh.material_ranges[0].triangle_count *= 2;
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            glm::vec3& position = mesh.positions[i];
            const bool is_near = i < half.positions.size();
            position.y = 0.5F * position.y + (is_near ? -1.0F : 1.0F);
            const glm::vec2 whole = 0.5F + glm::vec2(position.x, -position.y) / 4.0F;
            mesh.texcoords[i] = (is_near ? near : far)(whole);
        }
        scene.meshes[0] = mesh;
        return scene;
    };
    const Coordinates same = [](const glm::vec2& t) { return t; };
    const Image one = hills(48, 48);
    Image symmetric = one;  // By quarter turns about its center.
    for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 48; ++x) {
            const double sum = test::pixel(one, x, y)[0] + test::pixel(one, 47 - y, x)[0] +
                               test::pixel(one, 47 - x, 47 - y)[0] + test::pixel(one, y, 47 - x)[0];
            symmetric.as<std::uint16_t>()[static_cast<std::size_t>(48 * y + x)] =
                static_cast<std::uint16_t>(0.25 * sum);
        }
    }
    struct Case {
        const char* name;
        const Image& heights;
        Wrap wrap;
        Coordinates near;
        Coordinates far;
        bool meets;
    };
    for (const Case& c :
         {Case{"by whole periods", one, Wrap::repeat, same,
               [](const glm::vec2& t) { return t + glm::vec2(3, -2); }, true},
          Case{"mirrored", one, Wrap::mirror,
               [](const glm::vec2& t) { return glm::vec2(t.x, t.y + 0.5F); },
               [](const glm::vec2& t) { return glm::vec2(t.x, 1.5F - t.y); }, true},
          Case{"rotated", symmetric, Wrap::repeat, same,
               [](const glm::vec2& t) { return glm::vec2(1.0F - t.y, t.x); }, true},
          Case{"with other heights", one, Wrap::repeat, same,
               [](const glm::vec2& t) { return glm::vec2(0.7F - t.y, t.x); }, false}}) {
        if (test::is_sanitized && c.wrap == Wrap::mirror) continue;
        if (test::is_sanitized && &c.heights == &symmetric) continue;
        SCOPED_TRACE(c.name);
        const Scene plain = relief_scene(c.heights, camera_at(60.0), 6.0F, c.wrap);
        const Scene charts = with_charts(plain, c.near, c.far);
        const Scene near = with_charts(plain, c.near, c.near);
        const Scene far = with_charts(plain, c.far, c.far);
        const Reference exact = reference_of(charts);
        EXPECT_LT(apart(charts, exact).differing, 0.005);
        const std::array drawn = {picture(near), picture(far), picture(charts)};
        const auto codes = [](const Reference& reference, const Scene& scene) {
            return as_codes(reference_picture(reference.radiance, scene, OutputCoding::srgb));
        };
        const std::array expected = {codes(reference_of(near), near), codes(reference_of(far), far),
                                     codes(exact, charts)};
        for (const auto& [of_near, of_far, of_charts] : {drawn, expected}) {
            int compared = 0;
            int of_other = 0;  // Not those of the chart.
            int of_seam = 0;   // Not those of the near chart, beyond the seam.
            for (int y = 0; y < relief_side; ++y) {
                for (int x = 0; x < relief_side; ++x) {
                    if (test::pixel(exact.edges, x, y)[0] > 0.0) continue;
                    const ReferenceHit& hit =
                        exact.hits[static_cast<std::size_t>(relief_side * y + x)];
                    if (hit.instance == ReferenceHit::none) continue;
                    ++compared;
                    const bool is_near = hit.triangle < 2;
                    const double code = test::pixel(of_charts, x, y)[0];
                    const auto differs = [&](const Image& whole) {
                        return std::abs(code - test::pixel(whole, x, y)[0]) > 2.0 ? 1 : 0;
                    };
                    of_other += differs(is_near ? of_near : of_far);
                    of_seam += is_near ? 0 : differs(of_near);
                }
            }
            EXPECT_GT(compared, relief_side * relief_side / 8);
            EXPECT_LE(of_other, compared / 500);
            if (c.meets)
                EXPECT_LE(of_seam, compared / 500);
            else
                EXPECT_GT(of_seam, compared / 5);
        }
    }
}

/// On bricks at 60 degrees, each method is nearer to the exact picture than the one before.
TEST_F(DepthMapped, MethodsAreMoreAccurateInTheirOrder) {
    constexpr int pixels = 512;  // So that OpenGL averages few texels.
    Scene scene =
        with_texcoords(relief_scene(heights_of_bricks(), camera_at(60.0), 24.0F), glm::vec2(0.25F));
    const Reference reference = reference_of(scene, pixels);
    Scene plain = scene;
    plain.materials[0].height_map.reset();
    double before = apart(plain, reference, pixels).flip;
    for (const HeightMethod method :
         {HeightMethod::parallax, HeightMethod::parallax_occlusion, HeightMethod::relief_mapping,
          HeightMethod::maximum_mipmaps}) {
        scene.materials[0].height_map->method = method;
        const double flip = apart(scene, reference, pixels).flip;
        EXPECT_LT(flip, before) << enum_name(method);
        before = flip;
    }
    EXPECT_LT(before, 0.01);
}

TEST_F(DepthMapped, ConesOfFreeSpaceLeadToTheHits) {
    Scene scene = relief_scene(hills(32, 32), camera_at(50.0), 4.0F);
    scene.images.push_back({"cones", narrow_cones(hills(32, 32))});
    scene.materials[0].height_map->method = HeightMethod::relaxed_cones;
    scene.materials[0].height_map->cones = Texture{1};
    scene.materials[0].height_map->layers = 256;
    const Apart found = apart(scene);
    EXPECT_LT(found.differing, 0.01);
    EXPECT_LT(found.mean, 0.5);
}

TEST_F(DepthMapped, FloatHeightsWithHolesAndBeyondWhite) {
    Image heights = make_image(16, 16, 1, 32, ColorSpace::data);
    for (std::size_t i = 0; i < 256; ++i)
        heights.as<float>()[i] = static_cast<float>((i * 37) % 256) / 200.0F - 0.1F;
    heights.as<float>()[77] = std::numeric_limits<float>::quiet_NaN();
    Image colors = hills(16, 16);
    Scene scene = with_texcoords(relief_scene(heights, camera_at(50.0), 2.0F), glm::vec2(0.5F));
    scene.images.push_back({"colors", colors});
    scene.materials[0].diffuse_texture = Texture{1};
    EXPECT_LT(apart(scene).differing, 0.01);
}

/// Views along the surface, and from behind, displace nothing that is not finite.
TEST_F(DepthMapped, FlatViewsStayFinite) {
    for (const double degrees : {89.0, 89.99, 120.0}) {
        Scene scene = relief_scene(hills(64, 64), camera_at(degrees), 16.0F);
        scene.materials[0].double_sided = true;
        const Image drawn = radiance(scene, 64, 64);
        for (const float value : drawn.as<float>())
            EXPECT_TRUE(std::isfinite(value));
    }
}

TEST_F(DepthMapped, ColorsOfSecondTexcoordsMoveAlong) {
    Scene scene = relief_scene(hills(64, 64), camera_at(55.0), 6.0F);
    Mesh& mesh = scene.meshes[0].edit();
    for (const glm::vec2& texcoord : mesh.texcoords)
        mesh.texcoords_2.emplace_back(0.5F * texcoord.y, 0.2F + 0.7F * texcoord.x);
    scene.materials[0].diffuse_texture->second_texcoords = true;
    EXPECT_LT(apart(scene).differing, 0.005);
}

TEST_F(DepthMapped, ShowsOnUnlitAndFlatSurfaces) {
    for (const bool unlit : {false, true}) {
        Scene scene = relief_scene(hills(64, 64), camera_at(55.0), 6.0F);
        scene.materials[0].unlit = unlit;
        if (!unlit) scene.materials[0].interpolation = Interpolation::flat;
        EXPECT_LT(apart(scene).differing, 0.005);
    }
}

TEST(HeightLevels, HoldTheMaximaOfPatches) {
    Image image = make_image(3, 2, 1, 8, ColorSpace::data);
    image.samples = std::vector<std::uint8_t>{1, 5, 2, 9, 3, 4};
    const std::vector<Image> levels =
        shade::detail::height_levels(image, Wrap::repeat, Wrap::repeat);
    ASSERT_EQ(levels.size(), 2U);
    EXPECT_THAT(levels[0].as<std::uint8_t>(), ElementsAre(1, 5, 2, 9, 3, 4));
    EXPECT_THAT(levels[1].as<std::uint8_t>(), ElementsAre(9));
    const std::vector<Image> wide =
        shade::detail::height_levels(hills(5, 1), Wrap::clamp, Wrap::clamp);
    ASSERT_EQ(wide.size(), 3U);
    EXPECT_EQ(wide[1].width, 2);  // The second one covers three patches.
}

TEST(ReliefBound, IsTheLargestShiftOnTheScreen) {
    // 64 texels on 4 units: a depth of 8 texels is half a unit.
    const Scene near = relief_scene(hills(64, 64), camera_at(60.0), 8.0F);
    EXPECT_TRUE(planned(near).on);
    EXPECT_THAT(planned(near).reason, HasSubstr("moves what is seen by at most"));
    const Scene far = relief_scene(hills(64, 64), camera_at(60.0, 99.0), 0.5F);
    EXPECT_FALSE(planned(far).on);
    EXPECT_THAT(planned(far).reason, HasSubstr("pixels, less than 0.5"));
    // Seen exactly along the normal by an orthographic camera, a relief moves nothing.
    Scene above = relief_scene(hills(64, 64), camera_at(0.0), 8.0F);
    above.camera->orthographic_height = 4.0F;
    EXPECT_FALSE(planned(above).on);
    EXPECT_TRUE(planned(relief_scene(hills(64, 64), camera_at(0.0), 8.0F)).on);
    const Scene deep = relief_scene(hills(64, 64), camera_at(60.0), 1000.0F);
    EXPECT_TRUE(planned(deep).on);
    EXPECT_THAT(planned(deep).reason, HasSubstr("reaches the eye"));
    // A camera that is not known may be near.
    Scene unknown = far;
    unknown.camera.reset();
    EXPECT_TRUE(planned(unknown).on);
}

/// Near the bound, no pixel moves by more than half a pixel: it changes by no more than half of the
/// largest difference to a neighbor, and rounding.
TEST_F(DepthMapped, ReliefsBelowTheBoundMoveNoPixelByMore) {
    int left_out = 0;
    for (const double degrees : {20.0, 45.0, 70.0, 85.0}) {
        for (const float depth : {0.05F, 0.1F, 0.2F, 0.3F}) {
            Scene scene = relief_scene(hills(64, 64), camera_at(degrees, 9.0), depth);
            if (planned(scene).on) continue;
            ++left_out;
            const Image without = picture(scene);
            const Image with = picture(scene, {EffectBase::planned, {{"maximum mipmaps", true}}});
            int beyond = 0;
            for (int y = 1; y + 1 < relief_side; ++y) {
                for (int x = 1; x + 1 < relief_side; ++x) {
                    const double here = test::pixel(without, x, y)[0];
                    double steepest = 0.0;
                    for (const glm::ivec2& to : {glm::ivec2(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
                        const double there = test::pixel(without, x + to.x, y + to.y)[0];
                        steepest = std::max(steepest, std::abs(there - here));
                    }
                    const double change = std::abs(test::pixel(with, x, y)[0] - here);
                    beyond += change > 0.5 * steepest + 1.0 ? 1 : 0;
                }
            }
            EXPECT_EQ(beyond, 0) << degrees << " degrees, depth " << depth;
        }
    }
    EXPECT_GE(left_out, 4);
}

}  // namespace relief
