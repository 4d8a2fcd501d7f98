// SPDX-License-Identifier: Apache-2.0
// The blurred levels of a cube map on every backend.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "environment/convolution.h"
#include "gl/cube_map.h"
#include "gl/resources.h"
#include "relief/shade/image_compare.h"
#include "shade/environment/test_environments.h"
#include "support/gl_environment.h"
#include "support/labels.h"

namespace relief::shade::gl {
using namespace relief::shade::detail;

namespace {

using test::faces_of;

class Prefilter : public test::GlTest {
  protected:
    [[nodiscard]] CubeMap cube_of(const std::vector<Image>& faces) const {
        Report report;
        return make_cube_map(api(), faces, "room", report);
    }
};
RELIEF_ON_DEFAULT_BACKEND(Prefilter);

glm::dvec3 room(glm::dvec3 d) {
    const double sun = glm::dot(d, glm::normalize(glm::dvec3(0.3, 0.8, -0.5)));
    return glm::dvec3(0.5 + 0.3 * d.y, 0.5, 0.5 - 0.2 * d.x) + glm::dvec3(sun > 0.99 ? 60.0 : 0.0);
}

TEST_LABELS(not_sanitized);
TEST_P(Prefilter, HasLevelsDownToEightTexels) {
    for (const auto& [source, size, levels] :
         {std::array{1, 128, 5}, {3, 128, 5}, {255, 128, 5}, {256, 256, 6}, {300, 256, 6}}) {
        const CubeMap cube = make_prefiltered(
            api(), cube_of(faces_of(source, [](glm::dvec3) { return glm::dvec3(0.5, 2, 8); })));
        EXPECT_EQ(cube.size, size);
        EXPECT_EQ(cube.levels, levels);
        for (int level = 0; level < levels; ++level) {
            const std::vector<Image> faces = read_faces(api(), cube, level);
            ASSERT_EQ(faces[5].width, size >> level);
            for (const Image& face : faces) {
                for (std::size_t i = 0; i < face.sample_count(); ++i) {
                    const double expected = std::array{0.5, 2.0, 8.0}.at(i % 3);
                    // The rounding error of half floats.
                    ASSERT_NEAR(static_cast<double>(face.as<float>()[i]) / expected, 1.0, 1e-3);
                }
            }
        }
        EXPECT_EQ(read_faces(api(), cube, levels - 1)[0].width, 8);
    }
}

TEST_P(Prefilter, LevelZeroIsTheMirrorPicture) {
    for (const int source : {128, 256}) {
        const std::vector<Image> faces = faces_of(source, room);
        const CubeMap environment = cube_of(faces);
        const CubeMap cube = make_prefiltered(api(), environment);
        for (std::size_t face = 0; face < 6; ++face) {
            const Image stored = read_faces(api(), environment, 0)[face];
            // Lookups at texel centers. Drivers keep 8 bits of a position between texels.
            EXPECT_LT(compare(read_faces(api(), cube, 0)[face], stored).mean, 0.02);
        }
    }
}

TEST_P(Prefilter, EachLevelIsBlurredByItsRoughness) {
    const std::vector<Image> faces = faces_of(128, room);
    const CubeMap cube = make_prefiltered(api(), cube_of(faces));
    for (int level = 1; level < 5; ++level) {
        const std::vector<Image> blurred = read_faces(api(), cube, level);
        const int size = 128 >> level;
        double apart = 0.0;
        double all = 0.0;
        for (std::size_t face = 0; face < 6; ++face) {
            for (int i = 0; i < 12; ++i) {
                const int x = (5 * i + 3) % size;
                const int y = (7 * i + 2) % size;
                const glm::dvec3 expected =
                    blurred_radiance(faces,
                                     face_direction(face, 2.0 * (x + 0.5) / size - 1.0,
                                                    2.0 * (y + 0.5) / size - 1.0),
                                     level / 4.0);
                const float* sample =
                    blurred[face].as<float>().data() + static_cast<std::size_t>(3 * (y * size + x));
                const glm::dvec3 off = glm::dvec3(sample[0], sample[1], sample[2]) - expected;
                apart += glm::dot(off, off);
                all += glm::dot(expected, expected);
            }
        }
        EXPECT_LT(std::sqrt(apart / all), 0.02) << "level " << level;
    }
}

TEST_P(Prefilter, LookupsBetweenFacesAndLevelsHaveNoSeam) {
    const CubeMap cube = make_prefiltered(
        api(), cube_of(faces_of(64, [](glm::dvec3 d) { return glm::dvec3(d.x > d.z ? 1 : 0); })));
    const RenderTarget target(api(), 1, 1, ColorFormat::rgba32f, 1);
    api()->ActiveTexture(GL_TEXTURE0);
    api()->BindTexture(GL_TEXTURE_CUBE_MAP, cube.texture.name());
    const auto look_up = [&](const glm::vec3& direction, float level) {
        target.bind();
        test::cover(api(),
                    "uniform samplerCube cube;\nuniform vec3 direction;\nuniform float level;\n"
                    "out vec4 color;\nvoid main() { color = textureLod(cube, direction, level); "
                    "}\n",
                    [&](const LinkedProgram& program) {
                        program.set("cube", 0);
                        program.set("direction", direction);
                        program.set("level", level);
                    });
        const Image picture = target.read(ColorSpace::linear);
        return picture.as<float>()[0];
    };
    for (const float level : {1.0F, 2.5F, 4.0F}) {
        // Lookups across the edge of +x and +y, and beyond the last level.
        EXPECT_NEAR(look_up({1, 0.9999F, -0.5F}, level), look_up({0.9999F, 1, -0.5F}, level),
                    2e-3F);
    }
    EXPECT_EQ(look_up({1, 0.2F, 0.3F}, 4.0F), look_up({1, 0.2F, 0.3F}, 9.0F));
    api()->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
}

TEST_P(Prefilter, CodedFacesAndTheBrightestThereAreStayFinite) {
    std::vector<Image> coded;
    for (int face = 0; face < 6; ++face) {
        coded.push_back(make_image(10, 10, 3, 8, ColorSpace::srgb));
        for (auto& sample : coded.back().as<std::uint8_t>())
            sample = 200;
    }
    const std::vector<Image> even = read_faces(api(), make_prefiltered(api(), cube_of(coded)), 3);
    EXPECT_NEAR(even[2].as<float>()[0], linear_from_srgb(200.0F / 255.0F), 2e-3F);

    // The largest half float, and the largest radiance. The error of blurring is up to 2%.
    for (const auto& [radiance, limit] : {std::pair(65504.0F, 65504.0F), {1e18F, 1.02e18F}}) {
        const float brightest = radiance;  // Lambdas of Clang 14 capture no structured binding.
        const CubeMap blinding = make_prefiltered(api(), cube_of(faces_of(16, [&](glm::dvec3 d) {
                                                      return glm::dvec3(d.y > 0 ? brightest : 0);
                                                  })));
        for (int level = 0; level < blinding.levels; ++level) {
            for (const Image& face : read_faces(api(), blinding, level)) {
                for (const float sample : face.as<float>()) {
                    ASSERT_GE(sample, 0.0F);
                    ASSERT_LE(sample, limit);
                }
            }
        }
    }
}

TEST_P(Prefilter, DisturbsNoDrawingState) {
    const RenderTarget target(api(), 7, 5, ColorFormat::rgba8, 1);
    GLint framebuffer = 0;
    api()->GetIntegerv(GL_FRAMEBUFFER_BINDING, &framebuffer);
    api()->Enable(GL_DEPTH_TEST);
    const CubeMap cube = make_prefiltered(api(), cube_of(faces_of(4, room)));
    GLint bound = 0;
    std::array<GLint, 4> viewport{};
    api()->GetIntegerv(GL_FRAMEBUFFER_BINDING, &bound);
    api()->GetIntegerv(GL_VIEWPORT, viewport.data());
    EXPECT_EQ(bound, framebuffer);
    EXPECT_EQ(viewport, (std::array<GLint, 4>{0, 0, 7, 5}));
    EXPECT_EQ(api()->IsEnabled(GL_DEPTH_TEST), GL_TRUE);
    api()->Disable(GL_DEPTH_TEST);
}

}  // namespace
}  // namespace relief::shade::gl
