// SPDX-License-Identifier: Apache-2.0
// Cube maps: every direction finds what stands there in the six images; what cannot be is refused.
#include "gl/cube_map.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "cube_lookup.h"
#include "gl/resources.h"
#include "relief/mesh/error.h"
#include "relief/shade/error.h"
#include "relief/shade/image_compare.h"
#include "support/gl_environment.h"

namespace relief::gl {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class CubeMaps : public test::GlTest {};
RELIEF_ON_DEFAULT_BACKEND(CubeMaps);

/// The directions of OpenGL's table 3.10: s to the right, t downwards, both from -1 to 1.
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

/// Six faces whose texels hold what `radiance` says of their direction.
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
    // Within a face, direction is linear in s and t, which bilinear lookups keep; half floats leave
    // 2^-12 in each component, 0.02 degrees.
    EXPECT_LT(worst_degrees(look_up(api(), cube, inside), inside), 0.02);
    // At a corner three faces meet and what stands there is their mean: a part of a texel, which is
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
    // A seamless lookup at the edge of +x and +z is the mean of both faces; without, one of them.
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

TEST_P(CubeMaps, RadianceThatHalfFloatsCannotHoldIsClampedAndCounted) {
    const float inf = std::numeric_limits<float>::infinity();
    Image panorama = make_image(4, 2, 3, 32, ColorSpace::linear);
    panorama.as<float>()[3] = 1e6F;
    panorama.as<float>()[6] = inf;
    panorama.as<float>()[9] = -inf;
    panorama.as<float>()[10] = std::nanf("");
    Report report;
    const CubeMap cube = make_cube_map_from_panorama(api(), panorama, "sun", report, 8);
    EXPECT_EQ(report.count("radiance beyond half floats"), 1U);
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
    EXPECT_GT(brightest, 60000.0F);
    std::vector<Image> faces = float_faces_of(2, direction_itself);
    faces[4].as<float>()[0] = 70000.0F;
    Report of_faces;
    make_cube_map(api(), faces, "sun", of_faces);
    EXPECT_EQ(of_faces.count("radiance beyond half floats"), 1U);
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
              "cube map 'room': face -y differs from face +x in channels, bits or colour space");
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

}  // namespace
}  // namespace relief::gl
