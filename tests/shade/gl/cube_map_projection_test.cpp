// SPDX-License-Identifier: Apache-2.0
// Cube maps of panoramas and light probes: every direction finds what stands there in the image.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "cube_lookup.h"
#include "gl/cube_map.h"
#include "relief/mesh/error.h"
#include "relief/mesh/image_file.h"
#include "support/shared_data.h"

namespace relief::gl {
namespace {

using ::testing::ElementsAre;

class CubeMapProjection : public test::GlTest {};
RELIEF_ON_DEFAULT_BACKEND(CubeMapProjection);

/// A panorama whose texels hold what `radiance` says of their direction.
Image panorama_of(int width, const std::function<glm::vec3(glm::vec3)>& radiance) {
    const int height = width / 2;
    Image image = make_image(width, height, 3, 32, ColorSpace::linear);
    std::size_t i = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double longitude = 2.0 * std::numbers::pi * ((x + 0.5) / width - 0.5);
            const double latitude = std::numbers::pi * (0.5 - (y + 0.5) / height);
            const glm::vec3 value =
                radiance(glm::dvec3(std::sin(longitude) * std::cos(latitude), std::sin(latitude),
                                    -std::cos(longitude) * std::cos(latitude)));
            for (int c = 0; c < 3; ++c)
                image.as<float>()[i++] = value[c];
        }
    }
    return image;
}

/// Directions close to where the panorama wraps (+z), on both sides, from pole to pole.
std::vector<glm::vec3> directions_at_the_wrap() {
    std::vector<glm::vec3> directions;
    for (int i = 1; i < 1000; ++i) {
        const double polar = std::numbers::pi * i / 1000.0;
        const double offset = 0.001 * (i % 21 - 10);
        directions.emplace_back(std::sin(polar) * std::sin(offset), std::cos(polar),
                                std::sin(polar) * std::cos(offset));
    }
    return directions;
}

TEST_P(CubeMapProjection, APanoramaIsFoundInEveryDirection) {
    Report report;
    const CubeMap cube =
        make_cube_map_from_panorama(api(), panorama_of(512, direction_itself), "axes", report);
    EXPECT_EQ(cube.size, 128);
    EXPECT_EQ(cube.levels, 8);
    EXPECT_TRUE(report.empty());
    const std::vector<glm::vec3> all = spread_directions(5000);
    const std::vector<glm::vec3> inside = inside_faces(all, 128);
    const double worst = worst_degrees(look_up(api(), cube, inside), inside);
    RecordProperty("worst_degrees", std::to_string(worst));
    // Of a texel's 0.9 degrees in the middle of a face; half floats leave 0.02.
    EXPECT_LT(worst, 0.03);
    EXPECT_LT(worst_degrees(look_up(api(), cube, all), all), 0.125);  // At corners, as above.
}

TEST_P(CubeMapProjection, APanoramaHasNoSeamWhereItWraps) {
    Report report;
    const CubeMap cube =
        make_cube_map_from_panorama(api(), panorama_of(512, direction_itself), "axes", report);
    const std::vector<glm::vec3> directions = directions_at_the_wrap();
    const double worst = worst_degrees(look_up(api(), cube, directions), directions);
    RecordProperty("worst_degrees", std::to_string(worst));
    // As anywhere else. Clamping instead of wrapping would be wrong by half a texel, 0.35 degrees.
    EXPECT_LT(worst, 0.03);
}

TEST_P(CubeMapProjection, APanoramasPolesAndOddFacesHaveNoHole) {
    Report report;
    // With odd faces and an odd grid, one lookup is the pole itself, where longitude is undefined.
    for (const int size : {1, 3, 5}) {
        const CubeMap cube = make_cube_map_from_panorama(
            api(), panorama_of(16 * size, [](glm::vec3) { return glm::vec3(0.5F, 2, 8); }), "even",
            report, size);
        for (const glm::vec3& seen : look_up(api(), cube, spread_directions(500))) {
            // Filtering weights add up to 1 but for rounding; a hole would be far off.
            EXPECT_LT(glm::length(seen - glm::vec3(0.5F, 2, 8)), 1e-5F);
        }
    }
}

TEST_P(CubeMapProjection, SmallFacesMissNoTexelAtTheHorizon) {
    // One bright column; faces far coarser than the panorama must still receive its light.
    Image panorama = make_image(256, 128, 3, 32, ColorSpace::linear);
    for (std::size_t y = 0; y < 128; ++y)
        panorama.as<float>()[3 * (256 * y + 130)] = 64.0F;
    Report report;
    const CubeMap cube = make_cube_map_from_panorama(api(), panorama, "line", report, 4);
    const Image face = read_texture(api(), cube.texture, GL_TEXTURE_CUBE_MAP_NEGATIVE_Z, 0, 3, 32,
                                    ColorSpace::linear);
    double sum = 0.0;
    for (std::size_t x = 0; x < 4; ++x)
        sum += face.as<float>()[3 * (4 * 1 + x)];
    // A texel beside the middle spans atan(1/2) of 2 pi, 18.9 columns, of which one is lit.
    const double expected = 64.0 / (256.0 * std::atan(0.5) / (2.0 * std::numbers::pi));
    EXPECT_NEAR(sum, expected, 0.15 * expected);  // The grid has 21 lookups in that span.
}

/// How far the faces of a cube map are from six RGBE images.
struct FaceErrors {
    double relative_rms = 0.0;  ///< Root mean square, by the mean of all samples.
    double mean_steps = 0.0;    ///< In steps of a texel's RGBE code: 1/256 of its power of two.
    double worst_steps = 0.0;
    double share_beyond_a_step = 0.0;  ///< Of the samples, with a tenth of a step of tolerance.
};

FaceErrors errors_of_faces(const Api& api, const CubeMap& cube, const std::vector<Image>& faces) {
    FaceErrors errors;
    double squares = 0.0;
    double sum = 0.0;
    for (std::size_t face = 0; face < 6; ++face) {
        const Image read = read_texture(api, cube.texture,
                                        GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face),
                                        0, 3, 32, ColorSpace::linear);
        const auto ours = read.as<float>();
        const auto theirs = faces[face].as<float>();
        for (std::size_t i = 0; i < ours.size(); ++i) {
            const auto texel = theirs.subspan(i - i % 3, 3);
            int exponent = 0;
            std::frexp(std::max({texel[0], texel[1], texel[2]}), &exponent);
            const double apart = static_cast<double>(ours[i]) - static_cast<double>(theirs[i]);
            const double steps = apart / std::ldexp(1.0, exponent - 8);
            squares += apart * apart;
            sum += static_cast<double>(theirs[i]);
            errors.mean_steps += steps;
            errors.worst_steps = std::max(errors.worst_steps, std::abs(steps));
            if (steps < -0.1 || steps > 1.1) errors.share_beyond_a_step += 1.0;
        }
    }
    const double count = 6.0 * static_cast<double>(faces[0].sample_count());
    errors.relative_rms = std::sqrt(squares / count) / (sum / count);
    errors.mean_steps /= count;
    errors.share_beyond_a_step /= count;
    return errors;
}

TEST_P(CubeMapProjection, ARealPanoramaBecomesTheFacesThatOthersMadeOfIt) {
    RELIEF_NEEDS_SHARED(panorama_file, "data/env/equirect/venice_sunset_1k.hdr");
    RELIEF_NEEDS_SHARED(faces_folder, "data/env/cube/venice_sunset_256");
    const Image panorama = read_image(panorama_file, ImageUse::color);
    std::vector<Image> faces;
    for (const char* name : {"posx", "negx", "posy", "negy", "posz", "negz"}) {
        faces.push_back(read_image(faces_folder / (std::string(name) + ".hdr"), ImageUse::color));
    }
    Report report;
    const CubeMap cube = make_cube_map_from_panorama(api(), panorama, "venice", report);
    ASSERT_EQ(cube.size, 256);
    EXPECT_TRUE(report.empty());
    const FaceErrors errors = errors_of_faces(api(), cube, faces);
    RecordProperty("relative_rms", std::to_string(errors.relative_rms));
    RecordProperty("mean_steps", std::to_string(errors.mean_steps));
    RecordProperty("worst_steps", std::to_string(errors.worst_steps));
    RecordProperty("share_beyond_a_step", std::to_string(errors.share_beyond_a_step));
    // Those files hold the same 2 x 2 bilinear lookups, rounded down to 8 bits: just under half a
    // step too dark on average, and one at most, but for one sample in a thousand, where a
    // driver's rounding of the lookup's place tells.
    EXPECT_NEAR(errors.mean_steps, 0.45, 0.05);
    EXPECT_LT(errors.share_beyond_a_step, 2e-3);
    EXPECT_LT(errors.worst_steps, 4.0);
    EXPECT_LT(errors.relative_rms, 0.026);
    std::swap(faces[0], faces[1]);
    EXPECT_GT(errors_of_faces(api(), cube, faces).relative_rms, 0.5);
}

/// A light probe whose texels hold what `radiance` says of their direction; black outside the rim.
Image probe_of(int width, const std::function<glm::vec3(glm::vec3)>& radiance) {
    Image image = make_image(width, width, 3, 32, ColorSpace::linear);
    std::size_t i = 0;
    for (int y = 0; y < width; ++y) {
        for (int x = 0; x < width; ++x, i += 3) {
            const glm::dvec2 place(2.0 * (x + 0.5) / width - 1.0, 1.0 - 2.0 * (y + 0.5) / width);
            const double radius = glm::length(place);
            if (radius > 1.0) continue;
            const double angle = std::numbers::pi * radius;
            const glm::dvec2 side = radius > 0.0 ? place / radius : glm::dvec2(0.0);
            const glm::vec3 value = radiance(glm::dvec3(std::sin(angle) * side, -std::cos(angle)));
            for (int c = 0; c < 3; ++c)
                image.as<float>()[i + static_cast<std::size_t>(c)] = value[c];
        }
    }
    return image;
}

TEST_P(CubeMapProjection, ALightProbeIsFoundInEveryDirection) {
    Report report;
    const CubeMap cube =
        make_cube_map_from_angular_map(api(), probe_of(512, direction_itself), "ball", report);
    EXPECT_EQ(cube.size, 256);
    EXPECT_EQ(cube.levels, 9);
    EXPECT_TRUE(report.empty());
    std::vector<glm::vec3> inside;
    std::vector<glm::vec3> behind;
    for (const glm::vec3& direction : inside_faces(spread_directions(5000), 256)) {
        // At the rim a texel turns by half a circle; what the two outermost texels would hold is
        // 1.5 degrees there.
        (direction.z > 0.98F ? behind : inside).push_back(direction);
    }
    ASSERT_GT(behind.size(), 20U);
    EXPECT_LT(worst_degrees(look_up(api(), cube, inside), inside), 0.03);
    EXPECT_LT(worst_degrees(look_up(api(), cube, behind), behind), 1.5);
}

TEST_P(CubeMapProjection, ALightProbesRimIsNoDarkSpot) {
    Report report;
    const auto even = [](glm::vec3) { return glm::vec3(0.5F, 2, 8); };
    for (const int width : {1, 6, 33, 128}) {
        const CubeMap cube =
            make_cube_map_from_angular_map(api(), probe_of(width, even), "even", report);
        for (const glm::vec3& seen : look_up(api(), cube, spread_directions(500)))
            EXPECT_LT(glm::length(seen - glm::vec3(0.5F, 2, 8)), 1e-5F) << width;
        EXPECT_LT(glm::length(look_up(api(), cube, {{0, 0, 1}})[0] - glm::vec3(0.5F, 2, 8)), 1e-5F);
    }
}

TEST_P(CubeMapProjection, ARealLightProbeShowsTheRoomOfItsPanorama) {
    RELIEF_NEEDS_SHARED(probe_file, "data/env/angular/venice_sunset_angular_512.hdr");
    RELIEF_NEEDS_SHARED(panorama_file, "data/env/equirect/venice_sunset_1k.hdr");
    Report report;
    const CubeMap probe = make_cube_map_from_angular_map(
        api(), read_image(probe_file, ImageUse::color), "probe", report, 256);
    const CubeMap panorama = make_cube_map_from_panorama(
        api(), read_image(panorama_file, ImageUse::color), "panorama", report, 256);
    // Both were blurred differently on their way; at the 16 x 16 texels of level 4 that is gone.
    const auto directions = spread_directions(2000);
    const auto a = look_up(api(), probe, directions, 4.0F);
    const auto b = look_up(api(), panorama, directions, 4.0F);
    double apart = 0.0;
    double all = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        apart += static_cast<double>(glm::distance(a[i], b[i]));
        all += static_cast<double>(glm::length(b[i]));
    }
    RecordProperty("relative_difference", std::to_string(apart / all));
    EXPECT_LT(apart / all, 0.03);
    EXPECT_TRUE(report.empty());
}

TEST_P(CubeMapProjection, ALightProbeThatIsNotSquareIsRefused) {
    Report report;
    EXPECT_THROW(make_cube_map_from_angular_map(api(), make_image(4, 2, 3, 32, ColorSpace::linear),
                                                "oval", report),
                 InvalidInput);
    EXPECT_THROW(make_cube_map_from_angular_map(api(), make_image(4, 4, 3, 32, ColorSpace::linear),
                                                "negative", report, -1),
                 InvalidInput);
}

TEST_P(CubeMapProjection, ConvertingDisturbsNoDrawingState) {
    const RenderTarget target(api(), 7, 5, ColorFormat::rgba8, 1);
    GLint framebuffer = 0;
    api()->GetIntegerv(GL_FRAMEBUFFER_BINDING, &framebuffer);
    api()->Enable(GL_DEPTH_TEST);
    api()->Enable(GL_SCISSOR_TEST);
    api()->Scissor(0, 0, 1, 1);
    Report report;
    const CubeMap cube = make_cube_map_from_panorama(
        api(), panorama_of(32, [](glm::vec3) { return glm::vec3(3); }), "even", report);
    GLint bound = 0;
    std::array<GLint, 4> viewport{};
    api()->GetIntegerv(GL_FRAMEBUFFER_BINDING, &bound);
    api()->GetIntegerv(GL_VIEWPORT, viewport.data());
    EXPECT_EQ(bound, framebuffer);
    EXPECT_THAT(viewport, ElementsAre(0, 0, 7, 5));
    EXPECT_EQ(api()->IsEnabled(GL_DEPTH_TEST), GL_TRUE);
    EXPECT_EQ(api()->IsEnabled(GL_SCISSOR_TEST), GL_TRUE);
    EXPECT_EQ(api()->IsEnabled(GL_BLEND), GL_FALSE);
    api()->Disable(GL_DEPTH_TEST);
    api()->Disable(GL_SCISSOR_TEST);
    // Nor has the scissor cut the faces.
    EXPECT_LT(glm::length(look_up(api(), cube, {{0.9F, 0.8F, -1}})[0] - glm::vec3(3)), 1e-5F);
}

}  // namespace
}  // namespace relief::gl
