// SPDX-License-Identifier: Apache-2.0
// Targets: what is drawn is what is read, the right way up, in every format.
#include "gl/resources.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "relief/mesh/error.h"
#include "relief/shade/error.h"
#include "support/gl_environment.h"

namespace relief::gl {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class RenderTargets : public test::GlTest {};
RELIEF_ON_EACH_BACKEND(RenderTargets);

constexpr std::array<ColorFormat, 3> formats{ColorFormat::rgba8, ColorFormat::rgba16f,
                                             ColorFormat::rgba32f};

/// Red tells the column, green the row counted from the top, in steps of 1/255.
constexpr const char* coordinates_shader =
    "uniform int height;\nout vec4 color;\nvoid main() {\n"
    "    vec2 pixel = floor(gl_FragCoord.xy);\n"
    "    color = vec4(pixel.x, float(height) - 1.0 - pixel.y, 7.0, 255.0) / 255.0;\n}\n";

TEST_P(RenderTargets, RowZeroIsTheTopOfThePictureAtAnyOddSize) {
    constexpr std::array<std::array<int, 2>, 4> sizes{{{1, 1}, {3, 17}, {17, 3}, {255, 2}}};
    for (const auto& [width, height] : sizes) {
        for (const int samples : {1, 4}) {
            const RenderTarget target(api(), width, height, ColorFormat::rgba8, samples);
            test::cover(api(), coordinates_shader,
                        [h = height](const LinkedProgram& program) { program.set("height", h); });
            const Image image = target.read(ColorSpace::srgb);
            ASSERT_EQ(image.width, width);
            ASSERT_EQ(image.height, height);
            ASSERT_EQ(image.channels, 4);
            EXPECT_EQ(image.color_space, ColorSpace::srgb);
            const auto data = image.as<std::uint8_t>();
            for (std::size_t i = 0; i < data.size() / 4; ++i) {
                const std::size_t column = i % static_cast<std::size_t>(width);
                const std::size_t row = i / static_cast<std::size_t>(width);
                ASSERT_THAT(data.subspan(4 * i, 4), ElementsAre(column, row, 7, 255))
                    << width << " x " << height << ", " << samples << " samples";
            }
        }
    }
}

TEST_P(RenderTargets, FloatsAreNeitherClampedNorRounded) {
    const float inf = std::numeric_limits<float>::infinity();
    const std::vector<glm::vec4> values{
        {-2.5F, 1e-30F, 3e38F, 0.1F}, {inf, -inf, std::nanf(""), -0.0F}, {65504, 1, 2, 3}};
    const Buffer buffer = make_buffer(api(), values, "values");
    const Texture texture = make_buffer_texture(api(), buffer, GL_RGBA32F, 3, "values");
    const RenderTarget target(api(), 3, 1, ColorFormat::rgba32f, 1);
    api()->BindTexture(GL_TEXTURE_BUFFER, texture.name());
    test::cover(api(),
                "uniform samplerBuffer values;\nout vec4 color;\n"
                "void main() { color = texelFetch(values, int(gl_FragCoord.x)); }\n",
                [](const LinkedProgram& program) { program.set("values", 0); });
    const Image image = target.read(ColorSpace::linear);
    ASSERT_EQ(image.bits(), 32);
    for (std::size_t i = 0; i < 12; ++i) {
        const float expected = values[i / 4][static_cast<int>(i % 4)];
        const float read = image.as<float>()[i];
        EXPECT_TRUE(read == expected || (std::isnan(read) && std::isnan(expected)))
            << i << ": " << read << " instead of " << expected;
    }
}

TEST_P(RenderTargets, HalfFloatsKeepElevenBits) {
    const RenderTarget target(api(), 1, 1, ColorFormat::rgba16f, 1);
    test::cover(api(),
                "out vec4 color;\nvoid main() { color = vec4(0.1, -3.0, 65504.0, 2048.0); }");
    const Image image = target.read(ColorSpace::linear);
    EXPECT_NEAR(image.as<float>()[0], 0.1F, 0.1F * 0x1p-10F);  // Truncation is allowed.
    EXPECT_THAT(image.as<float>().subspan(1), ElementsAre(-3.0F, 65504.0F, 2048.0F));
}

TEST_P(RenderTargets, EightBitsRoundToTheNearestLevel) {
    const RenderTarget target(api(), 256, 1, ColorFormat::rgba8, 1);
    // A little above and below each level must not reach the next.
    test::cover(api(),
                "out vec4 color;\nvoid main() {\n    float i = floor(gl_FragCoord.x);\n"
                "    color = vec4(i, i + 0.4, i - 0.4, i) / 255.0;\n}\n");
    const Image image = target.read(ColorSpace::data);
    for (std::size_t i = 0; i < 256; ++i) {
        EXPECT_THAT(image.as<std::uint8_t>().subspan(4 * i, 4), ElementsAre(i, i, i, i));
    }
}

TEST_P(RenderTargets, FourSamplesSmoothAnEdgeAndOneDoesNot) {
    for (const ColorFormat format : formats) {
        for (const int samples : {1, 4}) {
            const RenderTarget target(api(), 64, 64, format, samples);
            api()->ClearColor(0, 0, 0, 0);
            api()->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            const LinkedProgram program(
                api(), {"slanted edge",
                        "#version 330 core\nvoid main() {\n"
                        "    gl_Position = vec4(gl_VertexID == 1 ? 0.9 : -0.9,\n"
                        "                       gl_VertexID == 2 ? 0.4 : -0.9, 0.0, 1.0);\n}\n",
                        "#version 330 core\nout vec4 color;\nvoid main() { color = vec4(1.0); }\n",
                        {},
                        {}});
            const VertexArray no_vertices(api());
            api()->BindVertexArray(no_vertices.name());
            program.use();
            api()->DrawArrays(GL_TRIANGLES, 0, 3);
            std::set<int> quarters;
            const Image image = to_float(target.read(ColorSpace::data));
            for (const float sample : image.as<float>()) {
                quarters.insert(static_cast<int>(std::lround(4.0F * sample)));
            }
            if (samples == 1) {
                EXPECT_THAT(quarters, ElementsAre(0, 4));
            } else {
                EXPECT_THAT(quarters, ElementsAre(0, 1, 2, 3, 4));
            }
            api()->BindVertexArray(0);
            api()->UseProgram(0);
        }
    }
}

TEST_P(RenderTargets, DepthHidesWhatIsBehind) {
    const RenderTarget target(api(), 4, 4, ColorFormat::rgba8, 4);
    api()->ClearColor(0, 0, 0, 0);
    api()->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    api()->Enable(GL_DEPTH_TEST);
    const auto cover_at = [&](const char* depth, const char* color) {
        test::cover(api(), fmt::format("out vec4 color;\nvoid main() {{ gl_FragDepth = {}; color = "
                                       "{}; }}\n",
                                       depth, color));
    };
    cover_at("0.25", "vec4(1.0, 0.0, 0.0, 1.0)");
    cover_at("0.75", "vec4(0.0, 1.0, 0.0, 1.0)");
    api()->Disable(GL_DEPTH_TEST);
    const Image picture = target.read(ColorSpace::data);
    EXPECT_THAT(picture.as<std::uint8_t>().subspan(0, 4), ElementsAre(255, 0, 0, 255));
}

TEST_P(RenderTargets, TheirColourServesAsATextureSampleBySample) {
    for (const int samples : {1, 4}) {
        const RenderTarget first(api(), 5, 3, ColorFormat::rgba8, samples);
        test::cover(api(), coordinates_shader,
                    [](const LinkedProgram& program) { program.set("height", 3); });
        const RenderTarget second(api(), 5, 3, ColorFormat::rgba8, 1);
        const GLenum target = samples > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D;
        api()->BindTexture(target, first.color().name());
        test::cover(
            api(),
            fmt::format("uniform {} picture;\nout vec4 color;\nvoid main() {{\n"
                        "    color = texelFetch(picture, ivec2(gl_FragCoord.xy), {});\n}}\n",
                        samples > 1 ? "sampler2DMS" : "sampler2D", samples - 1),
            [](const LinkedProgram& program) { program.set("picture", 0); });
        api()->BindTexture(target, 0);
        EXPECT_EQ(second.read(ColorSpace::data).samples, first.read(ColorSpace::data).samples);
    }
}

TEST_P(RenderTargets, SizesAndSamplesThatCannotBeAreRefusedWithTheLimit) {
    const auto error_of = [&](int width, int height, int samples) -> std::string {
        try {
            const RenderTarget target(api(), width, height, ColorFormat::rgba8, samples);
            return "no error";
        } catch (const Error& error) {
            return error.what();
        }
    };
    EXPECT_EQ(error_of(0, 5, 1), "a picture of 0 x 5 pixels cannot be drawn");
    EXPECT_EQ(error_of(5, -1, 1), "a picture of 5 x -1 pixels cannot be drawn");
    EXPECT_EQ(error_of(5, 5, 2), "2 samples a pixel are asked for; 1 or 4 can be");
    EXPECT_EQ(error_of(5, 5, 0), "0 samples a pixel are asked for; 1 or 4 can be");
    const int limit = std::min(api().limits().texture_size, api().limits().viewport_width);
    EXPECT_THAT(error_of(limit + 1, 1, 1),
                HasSubstr(fmt::format("a picture of {} x 1 pixels: ", limit + 1)));
    EXPECT_THAT(error_of(limit + 1, 1, 1), HasSubstr(fmt::format("at most {} x", limit)));
    EXPECT_EQ(error_of(limit, 1, 1), "no error");
}

}  // namespace
}  // namespace relief::gl
