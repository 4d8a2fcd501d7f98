// SPDX-License-Identifier: Apache-2.0
// GL resources: handles delete exactly what they own, and buffers, textures and framebuffers
// return the bytes that they were given.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "gl/api.h"
#include "gl/resources.h"
#include "relief/mesh/report.h"
#include "relief/shade/image_compare.h"
#include "relief/shade/renderer.h"
#include "support/gl_environment.h"
#include "support/images.h"

namespace relief::shade::gl {
namespace {

using test::samples_of;
using ::testing::ElementsAre;
using ::testing::FloatNear;
using ::testing::HasSubstr;
using ::testing::Pointwise;
using ::testing::VariantWith;

class Handles : public test::GlTest {};
RELIEF_ON_DEFAULT_BACKEND(Handles);

/// OpenGL creates a buffer object when its name is bound for the first time.
GLuint bound(const Api& api, const Buffer& buffer) {
    api->BindBuffer(GL_COPY_WRITE_BUFFER, buffer.name());
    api->BindBuffer(GL_COPY_WRITE_BUFFER, 0);
    return buffer.name();
}

TEST_P(Handles, AnEmptyOneHoldsZeroAndDeletesNothing) {
    const Texture empty;
    EXPECT_EQ(empty.name(), 0U);
    EXPECT_FALSE(empty);
    EXPECT_EQ(api().live_names(), 0U);
}

TEST_P(Handles, TheNameIsDeletedAtTheEndOfLife) {
    GLuint name = 0;
    {
        const Buffer buffer(api());
        name = bound(api(), buffer);
        EXPECT_EQ(api()->IsBuffer(name), GL_TRUE);
        EXPECT_EQ(api().live_names(), 1U);
    }
    EXPECT_EQ(api()->IsBuffer(name), GL_FALSE);
}

TEST_P(Handles, MovingLeavesTheSourceEmptyAndTheNameAlive) {
    Buffer source(api());
    const GLuint name = bound(api(), source);
    Buffer target(std::move(source));
    EXPECT_FALSE(source);  // NOLINT(bugprone-use-after-move): what it promises.
    EXPECT_EQ(target.name(), name);
    EXPECT_EQ(api()->IsBuffer(name), GL_TRUE);
    EXPECT_EQ(api().live_names(), 1U);
}

TEST_P(Handles, MoveAssignmentDeletesTheOldObject) {
    Buffer first(api());
    Buffer second(api());
    const GLuint first_name = bound(api(), first);
    const GLuint second_name = bound(api(), second);
    first = std::move(second);
    EXPECT_EQ(first.name(), second_name);
    EXPECT_EQ(api()->IsBuffer(first_name), GL_FALSE);
    EXPECT_EQ(api()->IsBuffer(second_name), GL_TRUE);
    Buffer& same = first;
    first = std::move(same);
    EXPECT_EQ(first.name(), second_name);
    EXPECT_EQ(api()->IsBuffer(second_name), GL_TRUE);
    first.reset();
    first.reset();
    EXPECT_EQ(api()->IsBuffer(second_name), GL_FALSE);
}

TEST_P(Handles, EveryKindIsMadeAndDeleted) {
    {
        const Buffer buffer(api());
        const Texture texture(api());
        const Sampler sampler(api());
        const VertexArray vertex_array(api());
        const Framebuffer framebuffer(api());
        const Renderbuffer renderbuffer(api());
        const Program program(api());
        const Shader shader(api(), GLenum{GL_VERTEX_SHADER});
        EXPECT_TRUE(buffer && texture && sampler && vertex_array && framebuffer && renderbuffer);
        EXPECT_EQ(api()->IsProgram(program.name()), GL_TRUE);
        EXPECT_EQ(api()->IsShader(shader.name()), GL_TRUE);
        EXPECT_EQ(api().live_names(), 8U);
    }
    EXPECT_EQ(api().live_names(), 0U);
}

TEST_P(Handles, AVectorThatGrowsKeepsItsNames) {
    std::vector<Buffer> buffers;
    std::vector<GLuint> names;
    for (int i = 0; i < 40; ++i) {
        buffers.emplace_back(api());
        names.push_back(bound(api(), buffers.back()));
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
        EXPECT_EQ(buffers[i].name(), names[i]);
        EXPECT_EQ(api()->IsBuffer(names[i]), GL_TRUE);
    }
}

class Buffers : public test::GlTest {};
RELIEF_ON_DEFAULT_BACKEND(Buffers);

std::vector<std::byte> bytes_of(const std::vector<float>& values) {
    const auto bytes = std::as_bytes(std::span(values));
    return {bytes.begin(), bytes.end()};
}

TEST_P(Buffers, KeepEveryByte) {
    std::vector<float> values(1001);
    std::iota(values.begin(), values.end(), -500.25F);
    EXPECT_EQ(read_buffer(api(), make_buffer(api(), values, "values")), bytes_of(values));
}

TEST_P(Buffers, MayBeEmpty) {
    EXPECT_TRUE(read_buffer(api(), make_buffer(api(), std::vector<float>{}, "nothing")).empty());
}

TEST_P(Buffers, ReplacedContentMayBeLargerOrSmaller) {
    const Buffer buffer =
        make_buffer(api(), std::vector<float>{1, 2, 3}, "values", GL_DYNAMIC_DRAW);
    for (const std::vector<float>& values : {std::vector<float>{4, 5, 6, 7}, {8}, {}}) {
        replace_content(api(), buffer, std::as_bytes(std::span(values)), "values");
        EXPECT_EQ(read_buffer(api(), buffer), bytes_of(values));
    }
}

TEST_P(Buffers, UploadingLeavesTheVertexArrayAlone) {
    const VertexArray vertex_array(api());
    const Buffer indices = make_buffer(api(), std::vector<GLuint>{0, 1, 2}, "indices");
    api()->BindVertexArray(vertex_array.name());
    api()->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices.name());
    const Buffer other = make_buffer(api(), std::vector<float>{1.0F}, "other");
    GLint element_binding = 0;
    api()->GetIntegerv(GL_ELEMENT_ARRAY_BUFFER_BINDING, &element_binding);
    EXPECT_EQ(static_cast<GLuint>(element_binding), indices.name());
    api()->BindVertexArray(0);
}

class Textures : public test::GlTest {};
RELIEF_ON_DEFAULT_BACKEND(Textures);

/// Drivers replace the division by 255 or 65535 by a multiplication, whose error is one bit of a
/// float.
constexpr float rounding = 0x1p-24F;

struct Size {
    int width;
    int height;
};

/// The sizes include odd ones: rows of 3 and 17 texels are not multiples of OpenGL's default
/// alignment of 4.
constexpr std::array<Size, 5> texture_sizes{{{1, 1}, {3, 17}, {17, 3}, {1, 64}, {64, 64}}};

/// Samples with every bit pattern. For floats, they include NaN and infinity.
Image random_image(Size size, int channels, int bits, ColorSpace color_space) {
    Image image = make_image(size.width, size.height, channels, bits, color_space);
    std::mt19937 random(7);
    std::visit(
        [&]<typename T>(std::vector<T>& samples) {
            for (T& sample : samples) {
                if constexpr (std::is_same_v<T, float>) {
                    sample = std::ldexp(static_cast<float>(random()) - 2e9F,
                                        static_cast<int>(random() % 60) - 60);
                } else {
                    sample = static_cast<T>(random());
                }
            }
        },
        image.samples);
    return image;
}

Image read_back(const Api& api, const Texture& texture, const Image& like) {
    return read_texture(api, texture, GL_TEXTURE_2D, 0, like.channels, like.bits(),
                        like.color_space);
}

/// Returns the result of a lookup at every texel as float RGBA, with row 0 on top.
Image look_up(const Api& api, const Texture& texture, Size size) {
    const RenderTarget target(api, size.width, size.height, ColorFormat::rgba32f, 1);
    test::cover(api,
                "uniform sampler2D picture;\nuniform int height;\nout vec4 color;\nvoid main() {\n"
                "    ivec2 pixel = ivec2(gl_FragCoord.xy);\n"
                "    color = texelFetch(picture, ivec2(pixel.x, height - 1 - pixel.y), 0);\n}\n",
                [&](const LinkedProgram& program) {
                    program.set("picture", 0);
                    program.set("height", size.height);
                    api->BindTexture(GL_TEXTURE_2D, texture.name());
                });
    api->BindTexture(GL_TEXTURE_2D, 0);
    return target.read(ColorSpace::linear);
}

TEST_P(Textures, IntegersOfEveryFormatAndOddSizeComeBackExactly) {
    for (const Size size : texture_sizes) {
        for (int channels = 1; channels <= 4; ++channels) {
            for (const int bits : {8, 16}) {
                const Image image = random_image(size, channels, bits, ColorSpace::data);
                const Texture texture = make_texture(api(), image, "random", false);
                EXPECT_EQ(compare(read_back(api(), texture, image), image).differing_pixels, 0U)
                    << size.width << " x " << size.height << " x " << channels << ", " << bits;
            }
        }
    }
}

TEST_P(Textures, CodedColorsComeBackAsTheyAreCoded) {
    for (const Size size : texture_sizes) {
        for (const int channels : {3, 4}) {
            const Image image = random_image(size, channels, 8, ColorSpace::srgb);
            const Texture texture = make_texture(api(), image, "random", false);
            EXPECT_EQ(compare(read_back(api(), texture, image), image).differing_pixels, 0U)
                << size.width << " x " << size.height << " x " << channels;
        }
    }
}

TEST_P(Textures, FloatsRoundTripIncludingNaN) {
    const float inf = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const Size size : texture_sizes) {
        for (int channels = 1; channels <= 4; ++channels) {
            Image image = random_image(size, channels, 32, ColorSpace::data);
            const std::array<float, 6> special{nan, inf, -inf, -0.0F, 3.4e38F, 1e-40F};
            const auto samples = image.as<float>();
            for (std::size_t i = 0; i < samples.size() && i < special.size(); ++i) {
                samples[i] = special.at(i);
            }
            const Texture texture = make_texture(api(), image, "random", false);
            const Image read = read_back(api(), texture, image);
            EXPECT_EQ(std::memcmp(read.as<float>().data(), samples.data(), samples.size_bytes()), 0)
                << size.width << " x " << size.height << " x " << channels;
        }
    }
}

TEST_P(Textures, HalvesRoundToTheNearest) {
    Image image = make_image(4, 1, 1, 32, ColorSpace::linear);
    // The significand has 11 bits: 2049 lies between 2048 and 2050, and 65504 is the largest value.
    const std::vector<float> values{0.1F, 2049.5F, 65504.0F, -1.0F / 3.0F};
    image.samples = values;
    const Texture texture = make_texture(api(), image, "halves", false, FloatStorage::half);
    const Image read = read_back(api(), texture, image);
    for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_NEAR(read.as<float>()[i], values[i], std::abs(values[i]) * 0x1p-11F) << i;
    }
}

TEST_P(Textures, LookUpWithRowZeroAtTZero) {
    const Image image = random_image({3, 17}, 4, 8, ColorSpace::data);
    const Image seen = look_up(api(), make_texture(api(), image, "random"), {3, 17});
    for (std::size_t i = 0; i < image.sample_count(); ++i) {
        EXPECT_NEAR(seen.as<float>()[i], image.as<std::uint8_t>()[i] / 255.0F, rounding);
    }
}

TEST_P(Textures, GrayIsSwizzled) {
    Image gray = make_image(1, 1, 1, 8, ColorSpace::data);
    gray.samples = std::vector<std::uint8_t>{51};
    const Image seen = look_up(api(), make_texture(api(), gray, "gray"), {1, 1});
    EXPECT_THAT(seen.samples, VariantWith<std::vector<float>>(
                                  Pointwise(FloatNear(rounding), {0.2F, 0.2F, 0.2F, 1.0F})));
    Image with_alpha = make_image(1, 1, 2, 16, ColorSpace::data);
    with_alpha.samples = std::vector<std::uint16_t>{13107, 52428};
    const Image both = look_up(api(), make_texture(api(), with_alpha, "gray"), {1, 1});
    EXPECT_THAT(both.samples, VariantWith<std::vector<float>>(
                                  Pointwise(FloatNear(rounding), {0.2F, 0.2F, 0.2F, 0.8F})));
}

TEST_P(Textures, CodedGrayIsDecodedAndItsAlphaIsNot) {
    Image gray = make_image(1, 1, 2, 8, ColorSpace::srgb);
    gray.samples = std::vector<std::uint8_t>{188, 51};
    const Image seen = look_up(api(), make_texture(api(), gray, "gray"), {1, 1});
    const float linear = linear_from_srgb(188.0F / 255.0F);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(seen.as<float>()[i], linear, 2e-3F);
    EXPECT_NEAR(seen.as<float>()[3], 0.2F, rounding);
}

TEST_P(Textures, EveryCodedColorIsDecodedToWithinHalfAStep) {
    Image ramp = make_image(256, 1, 3, 8, ColorSpace::srgb);
    for (std::size_t i = 0; i < ramp.sample_count(); ++i) {
        ramp.as<std::uint8_t>()[i] = static_cast<std::uint8_t>(i / 3);
    }
    const Image seen = look_up(api(), make_texture(api(), ramp, "ramp", false), {256, 1});
    double worst = 0.0;
    for (std::size_t i = 0; i < 256; ++i) {
        const double coded = 255.0 * srgb_from_linear(seen.as<float>()[4 * i]);
        worst = std::max(worst, std::abs(coded - static_cast<double>(i)));
    }
    RecordProperty("worst_in_coded_steps", std::to_string(worst));
    // Drivers approximate the curve. Within half a step, encoding returns the same code.
    EXPECT_LT(worst, 0.5);
}

TEST_P(Textures, Coded16BitColorsBecomeLinearFloats) {
    Image image = make_image(2, 1, 3, 16, ColorSpace::srgb);
    image.samples = std::vector<std::uint16_t>{0, 1, 1000, 30000, 65534, 65535};
    const Image expected = to_linear(image);
    const Image seen = look_up(api(), make_texture(api(), image, "deep", false), {2, 1});
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(seen.as<float>()[i + i / 3], expected.as<float>()[i]) << i;
    }
}

TEST_P(Textures, MipmapsOfColorsAreAveragedInLinearLight) {
    Image checker = make_image(2, 2, 3, 8, ColorSpace::srgb);
    checker.samples = std::vector<std::uint8_t>{0, 0, 0, 255, 255, 255, 255, 255, 255, 0, 0, 0};
    // Half of the light has the code 187.5. The mean of the codes would be 127 or 128.
    for (const auto& [color_space, expected] :
         {std::pair{ColorSpace::srgb, 187.5}, std::pair{ColorSpace::data, 127.5}}) {
        checker.color_space = color_space;
        const Texture texture = make_texture(api(), checker, "checker");
        const Image level = read_texture(api(), texture, GL_TEXTURE_2D, 1, 3, 8, color_space);
        for (const int sample : level.as<std::uint8_t>())
            EXPECT_NEAR(sample, expected, 0.5);
    }
}

TEST_P(Textures, LargerThanTheLimitAreRefusedWithTheLimit) {
    const int limit = api().limits().texture_size;
    const Image image = make_image(limit + 1, 1, 1, 8, ColorSpace::data);
    try {
        const Texture texture = make_texture(api(), image, "wide.png");
        FAIL() << "was accepted";
    } catch (const GpuError& error) {
        EXPECT_THAT(error.what(),
                    HasSubstr(fmt::format("'wide.png' has {} x 1 texels", limit + 1)));
        EXPECT_THAT(error.what(), HasSubstr(fmt::format("at most {} along a side", limit)));
    }
    const Image fits = make_image(limit, 1, 1, 8, ColorSpace::data);
    EXPECT_NO_THROW(make_texture(api(), fits, "fits"));
}

TEST_P(Textures, RefuseEmptyImages) {
    EXPECT_THROW(make_texture(api(), Image{}, "nothing"), InvalidInput);
}

/// Looks up texture unit 0 once at these texture coordinates.
float look_up_at(const Api& api, const Texture& texture, const Sampler& sampler, glm::vec2 st) {
    const RenderTarget target(api, 1, 1, ColorFormat::rgba32f, 1);
    api->BindTexture(GL_TEXTURE_2D, texture.name());
    api->BindSampler(0, sampler.name());
    test::cover(api,
                "uniform sampler2D picture;\nuniform vec2 st;\nout vec4 color;\n"
                "void main() { color = textureLod(picture, st, 0.0); }\n",
                [&](const LinkedProgram& program) {
                    program.set("picture", 0);
                    program.set("st", st);
                });
    api->BindSampler(0, 0);
    api->BindTexture(GL_TEXTURE_2D, 0);
    return samples_of<float>(target.read(ColorSpace::linear))[0];
}

TEST_P(Textures, OneImageIsLookedUpThroughDifferentSamplers) {
    Image image = make_image(4, 1, 1, 32, ColorSpace::data);
    image.samples = std::vector<float>{10, 20, 30, 40};
    const Texture texture = make_texture(api(), image, "steps");
    const auto at = [&](GLenum wrap, GLenum filter, float s) {
        const Sampler sampler = make_sampler(
            api(), {.wrap_s = wrap, .wrap_t = wrap, .minify = filter, .magnify = filter});
        return look_up_at(api(), texture, sampler, {s, 0.5F});
    };
    EXPECT_EQ(at(GL_REPEAT, GL_NEAREST, 1.125F), 10.0F);
    EXPECT_EQ(at(GL_CLAMP_TO_EDGE, GL_NEAREST, 1.125F), 40.0F);
    EXPECT_EQ(at(GL_MIRRORED_REPEAT, GL_NEAREST, 1.375F), 30.0F);
    EXPECT_FLOAT_EQ(at(GL_CLAMP_TO_EDGE, GL_LINEAR, 0.25F), 15.0F);
    EXPECT_FLOAT_EQ(at(GL_REPEAT, GL_LINEAR, 0.0F), 25.0F);
}

TEST_P(Textures, WithoutMipmapsTheyAreCompleteWithAnySampler) {
    Image image = make_image(4, 4, 1, 32, ColorSpace::data);
    image.samples = std::vector<float>(16, 3.0F);
    const Texture texture = make_texture(api(), image, "plain", false);
    const Sampler sampler = make_sampler(api(), {.minify = GL_LINEAR_MIPMAP_LINEAR});
    // A lookup of an incomplete texture would return 0.
    EXPECT_EQ(look_up_at(api(), texture, sampler, {0.3F, 0.3F}), 3.0F);
}

TEST_P(Textures, BufferTexturesAreReadByIndex) {
    const std::vector<float> values{1, 2, 3, 4, 5, 6, 7, 8};
    const Buffer buffer = make_buffer(api(), values, "values");
    const Texture texture = make_buffer_texture(api(), buffer, GL_RGBA32F, 2, "values");
    const RenderTarget target(api(), 1, 1, ColorFormat::rgba32f, 1);
    api()->BindTexture(GL_TEXTURE_BUFFER, texture.name());
    test::cover(api(),
                "uniform samplerBuffer values;\nout vec4 color;\n"
                "void main() { color = texelFetch(values, 1) + float(textureSize(values)); }\n",
                [](const LinkedProgram& program) { program.set("values", 0); });
    EXPECT_THAT(samples_of<float>(target.read(ColorSpace::linear)), ElementsAre(7, 8, 9, 10));
    const std::size_t too_many = static_cast<std::size_t>(api().limits().buffer_texels) + 1;
    EXPECT_THROW(make_buffer_texture(api(), buffer, GL_RGBA32F, too_many, "values"), GpuError);
}

class RenderTargets : public test::GlTest {};
RELIEF_ON_EACH_BACKEND(RenderTargets);

constexpr std::array<ColorFormat, 3> formats{ColorFormat::rgba8, ColorFormat::rgba16f,
                                             ColorFormat::rgba32f};

/// Red is the column and green the row from the top, in steps of 1/255.
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
    // Values slightly above and below each level must not reach the next level.
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

TEST_P(RenderTargets, TestDepth) {
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

TEST_P(RenderTargets, TheirColorServesAsATextureSampleBySample) {
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
    EXPECT_EQ(error_of(5, 5, 2), "2 samples per pixel were requested, but must be 1 or 4");
    EXPECT_EQ(error_of(5, 5, 0), "0 samples per pixel were requested, but must be 1 or 4");
    const int limit = std::min(api().limits().texture_size, api().limits().viewport_width);
    EXPECT_THAT(error_of(limit + 1, 1, 1),
                HasSubstr(fmt::format("a picture of {} x 1 pixels: ", limit + 1)));
    EXPECT_THAT(error_of(limit + 1, 1, 1), HasSubstr(fmt::format("at most {} x", limit)));
    EXPECT_EQ(error_of(limit, 1, 1), "no error");
}

}  // namespace
}  // namespace relief::shade::gl
