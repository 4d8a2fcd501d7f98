// SPDX-License-Identifier: Apache-2.0
// Cube maps of six images, panoramas and light probes: every direction finds its texel, and
// invalid input is refused.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "gl/cube_map.h"
#include "gl/resources.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "relief/shade/image_compare.h"
#include "relief/shade/renderer.h"
#include "shade/environment/test_environments.h"
#include "support/gl_environment.h"
#include "support/invariants.h"
#include "support/shared_data.h"

namespace relief::shade::gl {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Returns the results of lookups in these directions at one level of detail.
std::vector<glm::vec3> look_up(const Api& api, const CubeMap& cube,
                               const std::vector<glm::vec3>& directions, float level = 0.0F) {
    std::vector<glm::vec4> padded;
    for (const glm::vec3& direction : directions)
        padded.emplace_back(direction, 0.0F);
    const Buffer buffer = make_buffer(api, padded, "directions");
    const Texture list = make_buffer_texture(api, buffer, GL_RGBA32F, padded.size(), "directions");
    const RenderTarget target(api, static_cast<int>(padded.size()), 1, ColorFormat::rgba32f, 1);
    api->ActiveTexture(GL_TEXTURE1);
    api->BindTexture(GL_TEXTURE_BUFFER, list.name());
    api->ActiveTexture(GL_TEXTURE0);
    api->BindTexture(GL_TEXTURE_CUBE_MAP, cube.texture.name());
    test::cover(api,
                "uniform samplerCube cube;\nuniform samplerBuffer directions;\n"
                "uniform float level;\nout vec4 color;\nvoid main() {\n"
                "    vec3 direction = texelFetch(directions, int(gl_FragCoord.x)).xyz;\n"
                "    color = textureLod(cube, direction, level);\n}\n",
                [&](const LinkedProgram& program) {
                    program.set("cube", 0);
                    program.set("directions", 1);
                    program.set("level", level);
                });
    api->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
    const Image image = target.read(ColorSpace::linear);
    std::vector<glm::vec3> result;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        const auto texel = image.as<float>().subspan(4 * i, 3);
        result.emplace_back(texel[0], texel[1], texel[2]);
    }
    return result;
}

std::vector<glm::vec3> spread_directions(int count) {
    const std::vector<glm::dvec3> directions = test::spread_directions(count);
    return {directions.begin(), directions.end()};
}

/// Returns the largest angle between corresponding directions.
double worst_degrees(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
    double worst = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        worst = std::max(worst, test::degrees_between(glm::dvec3(a[i]), glm::dvec3(b[i])));
    }
    return worst;
}

/// Returns the directions whose bilinear lookup reads only one face.
std::vector<glm::vec3> inside_faces(const std::vector<glm::vec3>& directions, int size) {
    std::vector<glm::vec3> inside;
    for (const glm::vec3& direction : directions) {
        std::array<float, 3> axes{std::abs(direction.x), std::abs(direction.y),
                                  std::abs(direction.z)};
        std::ranges::sort(axes);
        if (axes[1] / axes[2] < 1.0F - 1.0F / static_cast<float>(size)) inside.push_back(direction);
    }
    return inside;
}

/// A radiance that identifies its direction.
const auto direction_itself = [](glm::vec3 direction) { return direction; };

class CubeMaps : public test::GlTest {};
RELIEF_ON_DEFAULT_BACKEND(CubeMaps);

/// The directions of table 3.10 of OpenGL: s runs to the right, t downwards, both from -1 to 1.
glm::vec3 direction_in_floats(std::size_t face, float s, float t) {
    switch (face) {
        case 0:
            return {1, -t, -s};
        case 1:
            return {-1, -t, s};
        case 2:
            return {s, 1, t};
        case 3:
            return {s, -1, -t};
        case 4:
            return {s, -t, 1};
        default:
            return {-s, -t, -1};
    }
}

/// Six faces whose texels hold the `radiance` of their direction.
std::vector<Image> float_faces_of(int size, const std::function<glm::vec3(glm::vec3)>& radiance) {
    std::vector<Image> faces;
    for (std::size_t face = 0; face < 6; ++face) {
        Image image = make_image(size, size, 3, 32, ColorSpace::linear);
        std::size_t i = 0;
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                const float s = 2.0F * (static_cast<float>(x) + 0.5F) / static_cast<float>(size);
                const float t = 2.0F * (static_cast<float>(y) + 0.5F) / static_cast<float>(size);
                const glm::vec3 value = radiance(direction_in_floats(face, s - 1.0F, t - 1.0F));
                for (int c = 0; c < 3; ++c)
                    image.as<float>()[i++] = value[c];
            }
        }
        faces.push_back(std::move(image));
    }
    return faces;
}

TEST_P(CubeMaps, EveryDirectionFindsItsTexelOfTheSixImages) {
    Report report;
    const CubeMap cube = make_cube_map(api(), float_faces_of(64, direction_itself), "axes", report);
    EXPECT_EQ(cube.size, 64);
    EXPECT_EQ(cube.levels, 7);
    EXPECT_TRUE(report.empty());
    const std::vector<glm::vec3> all = spread_directions(5000);
    const std::vector<glm::vec3> inside = inside_faces(all, 64);
    ASSERT_GT(inside.size(), 4500U);
    // Within a face, the direction is linear in s and t, and bilinear lookups keep it. Half floats
    // have an error of 2^-12 in each component, 0.02 degrees.
    EXPECT_LT(worst_degrees(look_up(api(), cube, inside), inside), 0.02);
    // At a corner the lookup is the mean of three faces. The error is a part of a texel, which is
    // 0.6 degrees there.
    EXPECT_LT(worst_degrees(look_up(api(), cube, all), all), 0.25);
}

TEST_P(CubeMaps, AxesFindTheMiddlesOfTheirFaces) {
    const auto name_of = [](glm::vec3 d) {
        const glm::vec3 size = glm::abs(d);
        const float axis = size.x >= 1.0F ? 1.0F : (size.y >= 1.0F ? 2.0F : 3.0F);
        return glm::vec3(axis * glm::sign(d[static_cast<int>(axis) - 1]), 0, 0);
    };
    Report report;
    const CubeMap cube = make_cube_map(api(), float_faces_of(4, name_of), "names", report);
    const auto seen =
        look_up(api(), cube, {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}});
    std::vector<float> names;
    for (const glm::vec3& value : seen)
        names.push_back(value.x);
    EXPECT_THAT(names, ElementsAre(1, -1, 2, -2, 3, -3));
}

TEST_P(CubeMaps, EdgesBetweenFacesAreBlendedAcross) {
    // A seamless lookup at the edge of +x and +z is the mean of both faces. Without it, the lookup
    // reads one face.
    const auto only_x = [](glm::vec3 d) { return glm::vec3(d.x == 1.0F ? 1.0F : 0.0F); };
    Report report;
    const CubeMap cube = make_cube_map(api(), float_faces_of(8, only_x), "half", report);
    EXPECT_NEAR(look_up(api(), cube, {{1, 0, 1}})[0].x, 0.5F, 0.01F);
}

TEST_P(CubeMaps, CodedFacesAreDecodedAtLookup) {
    std::vector<Image> faces;
    for (int face = 0; face < 6; ++face) {
        faces.push_back(make_image(2, 2, 3, 8, ColorSpace::srgb));
        for (auto& sample : faces.back().as<std::uint8_t>()) {
            sample = static_cast<std::uint8_t>(40 * face);
        }
    }
    Report report;
    const CubeMap cube = make_cube_map(api(), faces, "coded", report);
    const auto seen = look_up(api(), cube, {{1, 0, 0}, {0, 0, -1}});
    EXPECT_EQ(seen[0].x, 0.0F);
    EXPECT_NEAR(seen[1].y, linear_from_srgb(200.0F / 255.0F), 2e-3F);
    for (std::size_t face = 0; face < 6; ++face) {
        const Image read = read_texture(api(), cube.texture,
                                        GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face),
                                        0, 3, 8, ColorSpace::srgb);
        EXPECT_EQ(compare(read, faces[face]).max, 0.0);
    }
}

TEST_P(CubeMaps, TheSmallestLevelIsTheMeanOfAll) {
    Report report;
    const auto half_bright = [](glm::vec3 d) { return glm::vec3(d.y > 0.0F ? 2.0F : 0.0F); };
    const CubeMap cube = make_cube_map(api(), float_faces_of(16, half_bright), "sky", report);
    const auto seen = look_up(api(), cube, {{1, 0, 0}, {0, 1, 0}, {0, -1, 0}}, 4.0F);
    EXPECT_NEAR(seen[0].x, 1.0F, 1e-3F);
    EXPECT_NEAR(seen[1].x, 2.0F, 1e-3F);
    EXPECT_NEAR(seen[2].x, 0.0F, 1e-3F);
}

TEST_P(CubeMaps, KeepRadianceBeyondHalfFloats) {
    Image panorama = make_image(8, 4, 3, 32, ColorSpace::linear);
    for (float& sample : panorama.as<float>())
        sample = 1e6F;
    std::vector<Image> faces = float_faces_of(4, direction_itself);
    for (Image& face : faces)
        std::ranges::fill(face.as<float>(), 1e6F);
    Report report;
    for (const CubeMap& cube : {make_cube_map_from_panorama(api(), panorama, "sun", report),
                                make_cube_map(api(), faces, "sun", report)}) {
        EXPECT_EQ(cube.storage, FloatStorage::full);
        const CubeMap blurred = make_prefiltered(api(), cube);
        for (const float level : {0.0F, 1.0F, 4.0F}) {
            for (const glm::vec3& seen : look_up(api(), cube, {{1, 0, 0}, {0, 1, 1}}, level))
                EXPECT_NEAR(seen.x, 1e6F, 10.0F);
            for (const glm::vec3& seen : look_up(api(), blurred, {{1, 0, 0}, {0, 1, 1}}, level))
                EXPECT_NEAR(seen.x, 1e6F, 10.0F);
        }
    }
    EXPECT_TRUE(report.empty());
    // Other radiance takes half of the memory.
    EXPECT_EQ(make_cube_map(api(), float_faces_of(4, direction_itself), "sky", report).storage,
              FloatStorage::half);
}

TEST_P(CubeMaps, RadianceThatCannotBeStoredIsClampedAndCounted) {
    const float inf = std::numeric_limits<float>::infinity();
    Image panorama = make_image(4, 2, 3, 32, ColorSpace::linear);
    panorama.as<float>()[3] = 1e20F;
    panorama.as<float>()[6] = inf;
    panorama.as<float>()[9] = -inf;
    panorama.as<float>()[10] = std::nanf("");
    Report report;
    const CubeMap cube = make_cube_map_from_panorama(api(), panorama, "sun", report, 8);
    EXPECT_EQ(report.count("radiance beyond 1e18"), 1U);
    EXPECT_EQ(report.count("radiance that is not finite"), 3U);
    float brightest = 0.0F;
    for (std::size_t face = 0; face < 6; ++face) {
        const Image read = read_texture(api(), cube.texture,
                                        GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face),
                                        0, 3, 32, ColorSpace::linear);
        for (const float sample : read.as<float>()) {
            ASSERT_TRUE(std::isfinite(sample));
            brightest = std::max(brightest, sample);
        }
    }
    EXPECT_GT(brightest, 0.9e18F);
    std::vector<Image> faces = float_faces_of(2, direction_itself);
    faces[4].as<float>()[0] = 2e18F;
    Report of_faces;
    make_cube_map(api(), faces, "sun", of_faces);
    EXPECT_EQ(of_faces.count("radiance beyond 1e18"), 1U);
}

TEST_P(CubeMaps, FacesThatDoNotFitTogetherAreRefusedByName) {
    Report report;
    const auto error_of = [&](const std::vector<Image>& faces) -> std::string {
        try {
            make_cube_map(api(), faces, "room", report);
            return "no error";
        } catch (const InvalidInput& error) {
            return error.what();
        }
    };
    std::vector<Image> faces = float_faces_of(4, direction_itself);
    EXPECT_EQ(error_of({faces.begin(), faces.begin() + 5}),
              "cube map 'room' has 5 faces, but needs 6");
    faces[3] = make_image(4, 5, 3, 32, ColorSpace::linear);
    EXPECT_EQ(error_of(faces), "cube map 'room': face -y has 4 x 5 texels, but must be square");
    faces[3] = make_image(8, 8, 3, 32, ColorSpace::linear);
    EXPECT_EQ(error_of(faces), "cube map 'room': face -y has 8 x 8 texels, but face +x has 4 x 4");
    faces[3] = make_image(4, 4, 3, 8, ColorSpace::srgb);
    EXPECT_EQ(error_of(faces),
              "cube map 'room': face -y differs from face +x in channels, bits or color space");
    faces[0] = Image{};
    EXPECT_EQ(error_of(faces), "cube map 'room': face +x has no texels");
}

TEST_P(CubeMaps, SizesThatCannotBeAreRefusedWithTheLimit) {
    Report report;
    const Image panorama = make_image(4, 2, 3, 32, ColorSpace::linear);
    const int limit = api().limits().cube_size;
    try {
        make_cube_map_from_panorama(api(), panorama, "vast", report, limit + 1);
        FAIL() << "was accepted";
    } catch (const GpuError& error) {
        EXPECT_THAT(error.what(), HasSubstr("cube map 'vast' has faces of"));
        EXPECT_THAT(error.what(), HasSubstr(fmt::format("at most {}", limit)));
    }
    EXPECT_THROW(make_cube_map_from_panorama(api(), panorama, "negative", report, -1),
                 InvalidInput);
    EXPECT_THROW(make_cube_map_from_panorama(api(), Image{}, "nothing", report), InvalidInput);
}

TEST_P(CubeMaps, FacesReadBackAreLinearLightAtEveryLevel) {
    Report report;
    std::vector<Image> faces;
    for (int face = 0; face < 6; ++face) {
        faces.push_back(make_image(4, 4, 3, 8, ColorSpace::srgb));
        for (auto& sample : faces.back().as<std::uint8_t>())
            sample = static_cast<std::uint8_t>(40 * face);
    }
    const CubeMap coded = make_cube_map(api(), faces, "coded", report);
    const CubeMap linear =
        make_cube_map(api(), float_faces_of(4, direction_itself), "linear", report);
    for (int level = 0; level < 3; ++level) {
        const std::vector<Image> read = read_faces(api(), coded, level);
        ASSERT_EQ(read.size(), 6U);
        EXPECT_EQ(read[5].width, 4 >> level);
        EXPECT_EQ(read[5].color_space, ColorSpace::linear);
        EXPECT_NEAR(read[5].as<float>()[0], linear_from_srgb(200.0F / 255.0F), 1e-6F);
    }
    EXPECT_EQ(compare(read_faces(api(), linear, 0)[3], float_faces_of(4, direction_itself)[3]).max,
              0.0);
}

class CubeMapProjection : public test::GlTest {};
RELIEF_ON_DEFAULT_BACKEND(CubeMapProjection);

/// A panorama whose texels hold the `radiance` of their direction.
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

/// Directions on both sides of the seam of the panorama (+z), from pole to pole.
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

TEST_P(CubeMapProjection, PanoramaCoversEveryDirection) {
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
    // A texel in the middle of a face has 0.9 degrees. The error of half floats is 0.02.
    EXPECT_LT(worst, 0.03);
    EXPECT_LT(worst_degrees(look_up(api(), cube, all), all), 0.125);  // The error is larger at
                                                                      // corners.
}

TEST_P(CubeMapProjection, PanoramaWrapsWithoutASeam) {
    Report report;
    const CubeMap cube =
        make_cube_map_from_panorama(api(), panorama_of(512, direction_itself), "axes", report);
    const std::vector<glm::vec3> directions = directions_at_the_wrap();
    const double worst = worst_degrees(look_up(api(), cube, directions), directions);
    RecordProperty("worst_degrees", std::to_string(worst));
    // The error equals that of other directions. Clamping instead of wrapping would add half a
    // texel, 0.35 degrees.
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
            // Filter weights sum to 1 except for rounding. A hole would give a large difference.
            EXPECT_LT(glm::length(seen - glm::vec3(0.5F, 2, 8)), 1e-5F);
        }
    }
}

TEST_P(CubeMapProjection, SmallFacesMissNoTexelAtTheHorizon) {
    // One column is bright. Faces that are much coarser than the panorama must receive its light.
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
    // A texel next to the center spans atan(1/2) / (2 pi), or 18.9 columns, one of which is bright.
    const double expected = 64.0 / (256.0 * std::atan(0.5) / (2.0 * std::numbers::pi));
    EXPECT_NEAR(sum, expected, 0.15 * expected);  // The grid has 21 lookups in that range.
}

/// The difference between the faces of a cube map and six RGBE images.
struct FaceErrors {
    double relative_rms = 0.0;  ///< The root mean square, divided by the mean of all samples.
    double mean_steps = 0.0;    ///< In steps of a texel's RGBE code: 1/256 of its power of two.
    double worst_steps = 0.0;
    double share_beyond_a_step = 0.0;  ///< The share of samples whose error exceeds 1.1 steps.
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
    // The files hold the same 2 x 2 bilinear lookups, rounded down to 8 bits. On average they are
    // almost half a step too dark, and at most one step. One sample in a thousand exceeds this,
    // because drivers round the position of a lookup.
    EXPECT_NEAR(errors.mean_steps, 0.45, 0.05);
    EXPECT_LT(errors.share_beyond_a_step, 2e-3);
    EXPECT_LT(errors.worst_steps, 4.0);
    EXPECT_LT(errors.relative_rms, 0.026);
    std::swap(faces[0], faces[1]);
    EXPECT_GT(errors_of_faces(api(), cube, faces).relative_rms, 0.5);
}

/// A light probe whose texels hold the `radiance` of their direction. It is black outside the rim.
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

TEST_P(CubeMapProjection, LightProbeCoversEveryDirection) {
    Report report;
    const CubeMap cube =
        make_cube_map_from_angular_map(api(), probe_of(512, direction_itself), "ball", report);
    EXPECT_EQ(cube.size, 256);
    EXPECT_EQ(cube.levels, 9);
    EXPECT_TRUE(report.empty());
    std::vector<glm::vec3> inside;
    std::vector<glm::vec3> behind;
    for (const glm::vec3& direction : inside_faces(spread_directions(5000), 256)) {
        // At the rim, a texel spans half a circle. The two outermost texels cover 1.5 degrees
        // there.
        (direction.z > 0.98F ? behind : inside).push_back(direction);
    }
    ASSERT_GT(behind.size(), 20U);
    EXPECT_LT(worst_degrees(look_up(api(), cube, inside), inside), 0.03);
    EXPECT_LT(worst_degrees(look_up(api(), cube, behind), behind), 1.5);
}

TEST_P(CubeMapProjection, RimOfALightProbeIsNotDark) {
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
    // Both images had different blurs. At the 16 x 16 texels of level 4, the difference is
    // negligible.
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
    // The scissor test did not cut the faces.
    EXPECT_LT(glm::length(look_up(api(), cube, {{0.9F, 0.8F, -1}})[0] - glm::vec3(3)), 1e-5F);
}

}  // namespace
}  // namespace relief::shade::gl
