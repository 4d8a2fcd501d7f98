// SPDX-License-Identifier: Apache-2.0
// Textures: every format goes up and comes back exactly, and is looked up as the image means it.
#include "gl/resources.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "relief/mesh/error.h"
#include "relief/shade/error.h"
#include "relief/shade/image_compare.h"
#include "support/gl_environment.h"
#include "support/samples.h"

namespace relief::gl {
namespace {

using test::samples_of;
using ::testing::ElementsAre;
using ::testing::FloatNear;
using ::testing::HasSubstr;
using ::testing::Pointwise;
using ::testing::VariantWith;

class Textures : public test::GlTest {};
RELIEF_ON_DEFAULT_BACKEND(Textures);

/// Of a division by 255 or 65535, of which drivers make a multiplication: one bit of a float.
constexpr float rounding = 0x1p-24F;

struct Size {
    int width;
    int height;
};

/// Odd sizes too: rows of 3 and 17 texels are not multiples of OpenGL's default alignment of 4.
constexpr std::array<Size, 5> sizes{{{1, 1}, {3, 17}, {17, 3}, {1, 64}, {64, 64}}};

/// Every bit pattern that samples may have; for floats also those of NaN and infinity.
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

/// What a lookup at a texel gives, as float RGBA, of every texel, row 0 on top.
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
    for (const Size size : sizes) {
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

TEST_P(Textures, CodedColoursComeBackAsTheyAreCoded) {
    for (const Size size : sizes) {
        for (const int channels : {3, 4}) {
            const Image image = random_image(size, channels, 8, ColorSpace::srgb);
            const Texture texture = make_texture(api(), image, "random", false);
            EXPECT_EQ(compare(read_back(api(), texture, image), image).differing_pixels, 0U)
                << size.width << " x " << size.height << " x " << channels;
        }
    }
}

TEST_P(Textures, FloatsComeBackBitForBitEvenWhereTheyAreNoNumbers) {
    const float inf = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const Size size : sizes) {
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
    // 11 bits of mantissa: 2049 lies between 2048 and 2050, 65504 is the largest.
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

TEST_P(Textures, GreyIsSeenAsGreyWithAlphaInItsPlace) {
    Image gray = make_image(1, 1, 1, 8, ColorSpace::data);
    gray.samples = std::vector<std::uint8_t>{51};
    const Image seen = look_up(api(), make_texture(api(), gray, "grey"), {1, 1});
    EXPECT_THAT(seen.samples, VariantWith<std::vector<float>>(
                                  Pointwise(FloatNear(rounding), {0.2F, 0.2F, 0.2F, 1.0F})));
    Image with_alpha = make_image(1, 1, 2, 16, ColorSpace::data);
    with_alpha.samples = std::vector<std::uint16_t>{13107, 52428};
    const Image both = look_up(api(), make_texture(api(), with_alpha, "grey"), {1, 1});
    EXPECT_THAT(both.samples, VariantWith<std::vector<float>>(
                                  Pointwise(FloatNear(rounding), {0.2F, 0.2F, 0.2F, 0.8F})));
}

TEST_P(Textures, CodedGreyIsDecodedAndItsAlphaIsNot) {
    Image gray = make_image(1, 1, 2, 8, ColorSpace::srgb);
    gray.samples = std::vector<std::uint8_t>{188, 51};
    const Image seen = look_up(api(), make_texture(api(), gray, "grey"), {1, 1});
    const float linear = linear_from_srgb(188.0F / 255.0F);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(seen.as<float>()[i], linear, 2e-3F);
    EXPECT_NEAR(seen.as<float>()[3], 0.2F, rounding);
}

TEST_P(Textures, EveryCodedColourIsDecodedToWithinHalfAStep) {
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
    // Drivers approximate the curve; within half a step the same code results from encoding again.
    EXPECT_LT(worst, 0.5);
}

TEST_P(Textures, Coded16BitColoursBecomeLinearFloats) {
    Image image = make_image(2, 1, 3, 16, ColorSpace::srgb);
    image.samples = std::vector<std::uint16_t>{0, 1, 1000, 30000, 65534, 65535};
    const Image expected = to_linear(image);
    const Image seen = look_up(api(), make_texture(api(), image, "deep", false), {2, 1});
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(seen.as<float>()[i + i / 3], expected.as<float>()[i]) << i;
    }
}

TEST_P(Textures, MipmapsOfColoursAreAveragedInLinearLight) {
    Image checker = make_image(2, 2, 3, 8, ColorSpace::srgb);
    checker.samples = std::vector<std::uint8_t>{0, 0, 0, 255, 255, 255, 255, 255, 255, 0, 0, 0};
    // Half the light is coded as 187.5; averaging the codes would give 127 or 128.
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

TEST_P(Textures, OfNothingAreRefused) {
    EXPECT_THROW(make_texture(api(), Image{}, "nothing"), InvalidInput);
}

/// Looks texture unit 0 up once, at these texture coordinates.
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
    // An incomplete texture would be looked up as 0.
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

}  // namespace
}  // namespace relief::gl
