// SPDX-License-Identifier: Apache-2.0
// Codes of normal maps: exact flat, mirrored pairs, both meanings of zero, round trips by angle.
#include "relief/mesh/normal_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/image/normals/flat_codes.h"
#include "relief/mesh/error.h"
#include "relief/mesh/normal_map_operations.h"
#include "support/angle.h"
#include "support/samples.h"

namespace relief {
namespace {

using test::samples_of;
using testing::ElementsAre;
using testing::Pair;
using testing::UnorderedElementsAre;

using test::both_codes;

Image map_of(std::vector<float> samples) {
    Image image = make_image(static_cast<int>(samples.size() / 3), 1, 3, 32, ColorSpace::data);
    image.samples = std::move(samples);
    return image;
}

/// Unit normals all over the upper half of the sphere.
Image hemisphere() {
    std::vector<float> samples;
    for (int latitude = 0; latitude <= 60; ++latitude) {
        for (int longitude = 0; longitude < 90; ++longitude) {
            const double tilt = latitude * 0.026;
            const double turn = longitude * 0.07;
            for (const double part :
                 {std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt)})
                samples.push_back(static_cast<float>(part));
        }
    }
    return map_of(std::move(samples));
}

template <typename Code>
Image map_of(int channels, std::vector<Code> samples) {
    Image image = make_image(static_cast<int>(samples.size()) / channels, 1, channels,
                             sizeof(Code) * 8, ColorSpace::data);
    image.samples = std::move(samples);
    return image;
}

/// The largest angle in degrees that storing and reading back turns a normal by.
double largest_error(const NormalMapFormat& format) {
    const Image normals = hemisphere();
    Report report;
    const Image map = encode_normal_map(normals, format, report);
    const Image back = decode_normal_map(map, format.green, format.flat, report);
    EXPECT_TRUE(report.empty());
    double largest = 0.0;
    const std::span<const float> a = normals.as<float>();
    const std::span<const float> b = back.as<float>();
    for (std::size_t first = 0; first < a.size(); first += 3) {
        const glm::dvec3 read(b[first], b[first + 1], b[first + 2]);
        EXPECT_NEAR(glm::length(read), 1.0, 1e-6);
        largest = std::max(
            largest, test::degrees_between(glm::dvec3(a[first], a[first + 1], a[first + 2]), read));
    }
    return largest;
}

TEST(NormalMap, FlatAndTheAxesHaveTheKnownCodes) {
    const Image axes = map_of({0, 0, 1, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0});
    Report report;
    EXPECT_THAT(
        samples_of<std::uint8_t>(encode_normal_map(axes, {8, Green::up, FlatCode::middle}, report)),
        ElementsAre(128, 128, 255, 255, 128, 128, 1, 128, 128, 128, 255, 128, 128, 1, 128));
    EXPECT_THAT(
        samples_of<std::uint8_t>(encode_normal_map(axes, {8, Green::up, FlatCode::half}, report)),
        ElementsAre(128, 128, 255, 255, 128, 128, 0, 128, 128, 128, 255, 128, 128, 0, 128));
    EXPECT_THAT(samples_of<std::uint16_t>(
                    encode_normal_map(axes, {16, Green::down, FlatCode::middle}, report)),
                ElementsAre(32768, 32768, 65535, 65535, 32768, 32768, 1, 32768, 32768, 32768, 1,
                            32768, 32768, 65535, 32768));
    EXPECT_THAT(samples_of<float>(encode_normal_map(axes, {32, Green::up, FlatCode::half}, report)),
                ElementsAre(.5F, .5F, 1, 1, .5F, .5F, 0, .5F, .5F, .5F, 1, .5F, .5F, 0, .5F));
    EXPECT_TRUE(report.empty());
}

TEST(NormalMap, MiddleCodesDecodeFlatToExactlyFlatAndHalfCodesDoNot) {
    Report report;
    const Image bytes = map_of<std::uint8_t>(3, {128, 128, 255});
    const Image words = map_of<std::uint16_t>(3, {32768, 32768, 65535});
    for (const Image& map : {bytes, words}) {
        EXPECT_THAT(
            samples_of<float>(decode_normal_map(map, Green::down, FlatCode::middle, report)),
            ElementsAre(0.0F, 0.0F, 1.0F));
    }
    // Read by glTF's formula the same texel leans by atan(sqrt(2) / 255).
    const Image leaning = decode_normal_map(bytes, Green::up, FlatCode::half, report);
    const std::span<const float> n = leaning.as<float>();
    EXPECT_NEAR(test::degrees_between(glm::dvec3(n[0], n[1], n[2]), {0, 0, 1}), 0.3178, 1e-4);
}

TEST(NormalMap, FloatMapsHoldHalfThePlusOneAndFlatIsExact) {
    Report report;
    const Image map = encode_normal_map(map_of({0.6F, 0, 0.8F, 0, 0, 1}), {32}, report);
    EXPECT_THAT(map.as<float>(), ElementsAre(0.8F, 0.5F, 0.9F, 0.5F, 0.5F, 1.0F));
    const Image back = decode_normal_map(map, Green::up, FlatCode::half, report);
    EXPECT_THAT(back.as<float>().subspan(3), ElementsAre(0.0F, 0.0F, 1.0F));
}

TEST(NormalMap, OppositeSlopesHaveMirroredCodesSoThatMirroredSeamsCannotShow) {
    const Image normals = hemisphere();
    Image mirrored = normals;
    for (std::size_t first = 0; first < mirrored.sample_count(); first += 3) {
        mirrored.as<float>()[first] *= -1.0F;
        mirrored.as<float>()[first + 1] *= -1.0F;
    }
    Report report;
    for (const int bits : {8, 16}) {
        const NormalMapFormat format{bits, Green::up, FlatCode::middle};
        const Image a = to_float(encode_normal_map(normals, format, report));
        const Image b = to_float(encode_normal_map(mirrored, format, report));
        const double largest = bits == 8 ? 255.0 : 65535.0;
        for (std::size_t at = 0; at < a.sample_count(); ++at) {
            const double sum =
                std::round(a.as<float>()[at] * largest) + std::round(b.as<float>()[at] * largest);
            const double expected =
                at % 3 == 2 ? 2.0 * std::round(a.as<float>()[at] * largest) : largest + 1.0;
            ASSERT_EQ(sum, expected) << bits << " bits, sample " << at;
        }
    }
}

TEST(NormalMap, WhatIsStoredReadsBackWithinHalfACode) {
    // Half a code in three components: at most atan(sqrt(3) / 2 * 2 / 254) and the like.
    for (const FlatCode flat : both_codes) {
        for (const Green green : {Green::up, Green::down}) {
            EXPECT_LT(largest_error({8, green, flat}), 0.395);
            EXPECT_GT(largest_error({8, green, flat}), 0.2);
            EXPECT_LT(largest_error({16, green, flat}), 0.00152);
            // Float: 2^-25 in each of (n + 1) / 2.
            EXPECT_LT(largest_error({32, green, flat}), 1.2e-5);
        }
    }
}

TEST(NormalMap, GreenDownIsGreenUpWithTheOtherSign) {
    Report report;
    const Image map = map_of<std::uint8_t>(3, {150, 200, 220});
    const Image up = decode_normal_map(map, Green::up, FlatCode::middle, report);
    const Image down = decode_normal_map(map, Green::down, FlatCode::middle, report);
    EXPECT_EQ(up.as<float>()[0], down.as<float>()[0]);
    EXPECT_EQ(up.as<float>()[1], -down.as<float>()[1]);
    EXPECT_GT(up.as<float>()[1], 0.0F);
}

TEST(NormalMap, AFourthChannelIsIgnoredAndCodeZeroIsMinusOne) {
    Report report;
    const Image map = map_of<std::uint8_t>(4, {0, 128, 128, 3, 128, 128, 255, 200});
    EXPECT_THAT(samples_of<float>(decode_normal_map(map, Green::up, FlatCode::middle, report)),
                ElementsAre(-1.0F, 0.0F, 0.0F, 0.0F, 0.0F, 1.0F));
    EXPECT_TRUE(report.empty());
}

TEST(NormalMap, WhatIsNoDirectionIsFlatAndCounted) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    Report stored;
    const Image map =
        encode_normal_map(map_of({0, 0, 0, nan, 0, 1, 0, 0, 1, infinity, 0, 1}), {8}, stored);
    EXPECT_THAT(map.as<std::uint8_t>(),
                ElementsAre(128, 128, 255, 128, 128, 255, 128, 128, 255, 128, 128, 255));
    ASSERT_EQ(stored.findings().size(), 1U);
    EXPECT_EQ(stored.findings()[0],
              (Finding{"normal without direction", "texel", "stored as flat", 3, {0, 1, 3}}));
    Report read;
    const Image back = decode_normal_map(map_of<std::uint8_t>(3, {128, 128, 128}), Green::up,
                                         FlatCode::middle, read);
    EXPECT_THAT(back.as<float>(), ElementsAre(0.0F, 0.0F, 1.0F));
    EXPECT_EQ(read.count("normal without direction"), 1U);
}

TEST(NormalMap, OnlyTheDirectionCounts) {
    Report report;
    for (const float length : {1e-30F, 0.5F, 2.0F, 1e30F}) {
        const Image map = encode_normal_map(map_of({0.6F * length, 0, 0.8F * length}),
                                            {16, Green::up, FlatCode::middle}, report);
        EXPECT_THAT(map.as<std::uint16_t>(), ElementsAre(32768 + 19660, 32768, 32768 + 26214));
    }
    EXPECT_TRUE(report.empty());
}

TEST(NormalMap, WrongImagesAndDepthsAreRefused) {
    Report report;
    EXPECT_THROW(encode_normal_map(Image{}, {}, report), InvalidInput);
    EXPECT_THROW(encode_normal_map(make_image(1, 1, 3, 8, ColorSpace::data), {}, report),
                 InvalidInput);
    EXPECT_THROW(encode_normal_map(map_of({0, 0, 1}), {12}, report), InvalidInput);
    const Image gray = make_image(1, 1, 2, 8, ColorSpace::data);
    EXPECT_THROW(decode_normal_map(gray, Green::up, FlatCode::half, report), InvalidInput);
    EXPECT_THROW(detect_flat_code(gray), InvalidInput);
    EXPECT_THROW(detect_flat_code(Image{}), InvalidInput);
}

TEST(NormalMap, ZeroIsWhatTheMetadataSaysElseAsGltfDecodes) {
    const Image lower = map_of<std::uint8_t>(3, {127, 127, 255, 127, 128, 255, 10, 128, 200});
    const Image upper = map_of<std::uint8_t>(3, {128, 128, 255, 127, 128, 255, 127, 10, 200});
    EXPECT_EQ(detect_flat_code(lower), FlatCode::half);
    EXPECT_EQ(detect_flat_code(upper), FlatCode::half);
    EXPECT_EQ(detect_flat_code(map_of<std::uint16_t>(3, {32768, 32768, 65535})), FlatCode::half);
    EXPECT_EQ(detect_flat_code(upper, {{"relief:flat", "127.5"}}), FlatCode::half);
    EXPECT_EQ(detect_flat_code(lower, {{"relief:flat", "128"}}), FlatCode::middle);
    EXPECT_EQ(detect_flat_code(lower, {{"relief:flat", "32768"}}), FlatCode::middle);
    EXPECT_EQ(detect_flat_code(upper, {{"relief:flat", "what?"}}), FlatCode::half);
}

TEST(NormalMap, TheDefaultIsWhatGltfAndEnginesDecode) {
    const Image normals = hemisphere();
    Report report;
    for (const int bits : {8, 16}) {
        NormalMapFormat format;
        format.bits = bits;
        const Image map = to_float(encode_normal_map(normals, format, report));
        double largest = 0.0;
        for (std::size_t first = 0; first < map.sample_count(); first += 3) {
            // glTF 2.0: the components 0 to 1 of a texel map to -1 to 1.
            const auto decoded = [&](std::size_t i) {
                return 2.0 * static_cast<double>(map.as<float>()[first + i]) - 1.0;
            };
            const glm::dvec3 ground_truth(normals.as<float>()[first],
                                          normals.as<float>()[first + 1],
                                          normals.as<float>()[first + 2]);
            largest = std::max(
                largest, test::degrees_between({decoded(0), decoded(1), decoded(2)}, ground_truth));
        }
        // Half a code in three components, and none of another zero.
        EXPECT_LT(largest, bits == 8 ? 0.395 : 0.0016);
    }
}

TEST(NormalMap, FlatIsExactlyFlatUnderBothZeros) {
    // A flat quarter beside normals all around.
    Image normals = hemisphere();
    const std::size_t flat_samples = normals.sample_count() / 3 / 4 * 3;
    for (std::size_t i = 0; i < flat_samples; ++i)
        normals.as<float>()[i] = i % 3 == 2 ? 1.0F : 0.0F;
    Report report;
    for (const FlatCode flat : both_codes) {
        for (const int bits : {8, 16}) {
            for (const Green green : {Green::up, Green::down}) {
                Image map = encode_normal_map(normals, {bits, green, flat}, report);
                if (green == Green::down)  // Turned round by its codes: 128 becomes 127.
                    map_axes(map, {{{0, false}, {1, true}, {2, false}}}, flat, report);
                const Image exact =
                    decode_normal_map(map, Green::up, flat, report, FlatTexels::exact);
                const Image as_coded = decode_normal_map(map, Green::up, flat, report);
                for (std::size_t i = 0; i < flat_samples; ++i)
                    ASSERT_EQ(exact.as<float>()[i], i % 3 == 2 ? 1.0F : 0.0F);
                // All others are what the formula says.
                for (std::size_t i = flat_samples; i < normals.sample_count(); ++i)
                    ASSERT_NEAR(exact.as<float>()[i], as_coded.as<float>()[i], 0.004F);
                EXPECT_EQ(flat_texel_codes(map).has_value(), true);
            }
        }
    }
    EXPECT_TRUE(report.empty());
}

TEST(NormalMap, FlatTexelsHaveCodesOnlyWhereOnePairOfCodesPrevails) {
    EXPECT_THAT(flat_texel_codes(map_of<std::uint8_t>(3, {128, 127, 255, 9, 128, 200})).value(),
                ElementsAre(128, 127));
    EXPECT_THAT(flat_texel_codes(map_of<std::uint16_t>(3, {32767, 32767, 65535})).value(),
                ElementsAre(32767, 32767));
    EXPECT_THAT(flat_texel_codes(map_of<std::uint8_t>(3, {128, 9, 128}), 0, 2).value(),
                ElementsAre(128, 128));
    // Three of four, and fewer.
    EXPECT_TRUE(
        flat_texel_codes(map_of<std::uint8_t>(2, {128, 128, 128, 128, 127, 128, 128, 128})));
    EXPECT_FALSE(flat_texel_codes(map_of<std::uint8_t>(2, {128, 128, 128, 128, 127, 128})));
    EXPECT_FALSE(flat_texel_codes(map_of<std::uint8_t>(2, {126, 128, 128, 129})));
    EXPECT_FALSE(flat_texel_codes(map_of<float>(3, {0.5F, 0.5F, 1.0F})));
    EXPECT_THROW(flat_texel_codes(Image{}), InvalidInput);
    EXPECT_THROW(flat_texel_codes(map_of<std::uint8_t>(2, {1, 2}), 0, 2), InvalidInput);
    // Dithered flat ground: each of the four pairs is a direction of its own.
    std::vector<float> flat;
    for (int i = 0; i < 64 * 64; ++i)
        flat.insert(flat.end(), {0.0F, 0.0F, 1.0F});
    Image normals = map_of(std::move(flat));
    normals.width = normals.height = 64;
    Report report;
    for (const Dither dither : {Dither::ordered, Dither::blue_noise}) {
        EXPECT_FALSE(flat_texel_codes(
            encode_normal_map(normals, {8, Green::up, FlatCode::half, dither}, report)));
    }
}

TEST(NormalMap, MetadataSaysWhatTheMapHoldsAndIsUnderstoodAgain) {
    EXPECT_THAT(normal_map_metadata({16, Green::down, FlatCode::middle}),
                UnorderedElementsAre(Pair("relief:content", "normal map, tangent space"),
                                     Pair("relief:green", "down"), Pair("relief:flat", "32768")));
    EXPECT_EQ(normal_map_metadata({16, Green::up, FlatCode::half}).at("relief:flat"), "32767.5");
    EXPECT_EQ(normal_map_metadata({8, Green::up, FlatCode::middle}).at("relief:flat"), "128");
    EXPECT_EQ(normal_map_metadata({32, Green::up, FlatCode::half}).at("relief:flat"), "0.5");
    const Image any = map_of<std::uint8_t>(3, {1, 2, 3});
    for (const int bits : {8, 16}) {
        for (const FlatCode flat : both_codes)
            EXPECT_EQ(detect_flat_code(any, normal_map_metadata({bits, Green::up, flat})), flat);
    }
}

}  // namespace
}  // namespace relief
