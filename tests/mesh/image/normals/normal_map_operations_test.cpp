// SPDX-License-Identifier: Apache-2.0
// Axes turned on codes come back bit for bit, z is found again, lengths are judged by what codes
// can hold, slopes are scaled as heights would scale them.
#include "relief/mesh/normal_map_operations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/image/normals/flat_codes.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/error.h"
#include "relief/mesh/normal_map.h"
#include "support/message_of.h"
#include "support/samples.h"

namespace relief {
namespace {

using test::message_of;
using test::samples_of;
using testing::ElementsAre;
using testing::FloatEq;

using test::both_codes;

template <typename Sample>
Image image_of(int channels, std::vector<Sample> samples) {
    Image image = make_image(static_cast<int>(samples.size()) / channels, 1, channels,
                             sizeof(Sample) * 8, ColorSpace::data);
    image.samples = std::move(samples);
    return image;
}

/// Every code in each of the channels, from `first` on, in a different order in each.
template <typename Code>
Image all_codes(int channels, std::size_t first) {
    const std::size_t count = std::size_t{std::numeric_limits<Code>::max()} + 1 - first;
    std::vector<Code> samples;
    for (std::size_t i = 0; i < count; ++i) {
        for (int c = 0; c < channels; ++c)
            samples.push_back(
                static_cast<Code>(first + (i + static_cast<std::size_t>(c) * 77) % count));
    }
    return image_of(channels, std::move(samples));
}

std::vector<AxisMapping> all_mappings() {
    std::vector<AxisMapping> result;
    std::array<int, 3> axes = {0, 1, 2};
    do {
        for (unsigned signs = 0; signs < 8; ++signs) {
            result.push_back({{{axes[0], (signs & 1U) != 0},
                               {axes[1], (signs & 2U) != 0},
                               {axes[2], (signs & 4U) != 0}}});
        }
    } while (std::next_permutation(axes.begin(), axes.end()));
    return result;
}

AxisMapping inverse(const AxisMapping& mapping) {
    AxisMapping result;
    for (int to = 0; to < 3; ++to) {
        const SignedAxis from = mapping[static_cast<std::size_t>(to)];
        result[static_cast<std::size_t>(from.axis)] = {to, from.is_negative};
    }
    return result;
}

template <typename Code>
void expect_codes_to_come_back(int channels) {
    for (const FlatCode flat : both_codes) {
        const Image original = all_codes<Code>(channels, flat == FlatCode::middle ? 1 : 0);
        for (const AxisMapping& mapping : all_mappings()) {
            Image map = original;
            Report report;
            map_axes(map, mapping, flat, report);
            map_axes(map, inverse(mapping), flat, report);
            ASSERT_EQ(map.samples, original.samples);
            ASSERT_TRUE(report.empty());
        }
    }
}

TEST(MapAxes, EverySignedPermutationOfCodesComesBackBitForBit) {
    ASSERT_EQ(all_mappings().size(), 48U);
    expect_codes_to_come_back<std::uint8_t>(3);
    expect_codes_to_come_back<std::uint8_t>(4);
    expect_codes_to_come_back<std::uint16_t>(3);
}

TEST(MapAxes, TurnsWhatTheCodesMean) {
    // x from -z, y from x, z from y.
    const AxisMapping mapping = {{{2, true}, {0, false}, {1, false}}};
    for (const FlatCode flat : both_codes) {
        const Image original = all_codes<std::uint8_t>(4, 1);
        Image map = original;
        Report report;
        map_axes(map, mapping, flat, report);
        const Image before = decode_normal_map(original, Green::up, flat, report);
        const Image after = decode_normal_map(map, Green::up, flat, report);
        for (std::size_t i = 0; i < before.sample_count(); i += 3) {
            const float* const a = &before.as<float>()[i];
            const float* const b = &after.as<float>()[i];
            ASSERT_THAT(std::vector<float>(b, b + 3),
                        ElementsAre(FloatEq(0.0F - a[2]), FloatEq(a[0]), FloatEq(a[1])));
        }
        for (std::size_t i = 3; i < map.sample_count(); i += 4)
            ASSERT_EQ(map.as<std::uint8_t>()[i], original.as<std::uint8_t>()[i]);
    }
}

TEST(MapAxes, ACodeWithoutOppositeIsCounted) {
    constexpr AxisMapping flip_green = {{{0, false}, {1, true}, {2, false}}};
    Image map = image_of<std::uint8_t>(3, {0, 0, 255, 0, 1, 255});
    Report report;
    map_axes(map, flip_green, FlatCode::middle, report);
    EXPECT_THAT(samples_of<std::uint8_t>(map), ElementsAre(0, 255, 255, 0, 255, 255));
    EXPECT_EQ(report.count("code 0 without an opposite"), 1U);
    Report none;
    Image half = image_of<std::uint16_t>(3, {0, 0, 65535, 1, 65535, 0});
    map_axes(half, flip_green, FlatCode::half, none);
    EXPECT_THAT(samples_of<std::uint16_t>(half), ElementsAre(0, 65535, 65535, 1, 0, 0));
    EXPECT_TRUE(none.empty());
}

TEST(MapAxes, FloatsComeBackWithinTheirRounding) {
    constexpr AxisMapping flip_red = {{{0, true}, {1, false}, {2, false}}};
    std::vector<float> samples;
    for (int i = 0; i < 3000; ++i)
        samples.push_back(static_cast<float>(std::fmod(i * 0.618033988749895, 1.0)));
    const Image original = image_of(3, samples);
    Image map = original;
    Report report;
    map_axes(map, flip_red, FlatCode::middle, report);
    map_axes(map, flip_red, FlatCode::middle, report);
    for (std::size_t i = 0; i < samples.size(); ++i)
        ASSERT_NEAR(map.as<float>()[i], samples[i], i % 3 == 0 ? 0x1p-24 : 0.0);
    Image flat = image_of<float>(3, {0.5F, 0.5F, 1.0F});
    map_axes(flat, flip_red, FlatCode::middle, report);
    EXPECT_THAT(samples_of<float>(flat), ElementsAre(0.5F, 0.5F, 1.0F));
}

TEST(MapAxes, RefusesWhatIsNoPermutation) {
    Image map = all_codes<std::uint8_t>(3, 1);
    Report report;
    EXPECT_EQ(message_of<InvalidInput>([&] {
                  map_axes(map, {{{0, false}, {0, true}, {2, false}}}, FlatCode::half, report);
              }),
              "axis x is used twice");
    EXPECT_EQ(message_of<InvalidInput>([&] {
                  map_axes(map, {{{0, false}, {3, true}, {2, false}}}, FlatCode::half, report);
              }),
              "there is no axis 3, only 0, 1 and 2");
    Image two = image_of<std::uint8_t>(2, {1, 2, 3, 4});
    EXPECT_EQ(message_of<InvalidInput>([&] { map_axes(two, same_axes, FlatCode::half, report); }),
              "a normal map has 3 or 4 channels, not 2");
}

TEST(DecodeXyMap, FindsZAndKeepsWhatIsLongerThanOneInThePlane) {
    // 8 bits, middle: (60, -80) of 127 and (127, 127) of 127.
    const Image map = image_of<std::uint8_t>(4, {188, 48, 7, 9, 255, 255, 7, 9});
    Report report;
    const Image normals = decode_xy_map(map, {0, 1}, Green::up, FlatCode::middle, report);
    const double z = std::sqrt(127.0 * 127.0 - 10000.0);
    const auto n = normals.as<float>();
    EXPECT_FLOAT_EQ(n[0], 60.0F / 127.0F);
    EXPECT_FLOAT_EQ(n[1], -80.0F / 127.0F);
    EXPECT_FLOAT_EQ(n[2], static_cast<float>(z / 127.0));
    EXPECT_FLOAT_EQ(n[3], std::sqrt(0.5F));
    EXPECT_FLOAT_EQ(n[4], std::sqrt(0.5F));
    EXPECT_EQ(n[5], 0.0F);
    EXPECT_EQ(report.count("x and y longer than 1"), 1U);
    ASSERT_EQ(report.findings().size(), 1U);
    EXPECT_THAT(report.findings()[0].first, ElementsAre(1));
}

TEST(DecodeXyMap, TakesAnyTwoChannelsInEitherGreen) {
    // x in alpha, y in green, as DXT5 normal maps have it.
    const Image map = image_of<std::uint8_t>(4, {0, 48, 0, 188});
    Report report;
    const Image normals = decode_xy_map(map, {3, 1}, Green::down, FlatCode::middle, report);
    EXPECT_FLOAT_EQ(normals.as<float>()[0], 60.0F / 127.0F);
    EXPECT_FLOAT_EQ(normals.as<float>()[1], 80.0F / 127.0F);
    const Image two = image_of<float>(2, {0.5F, 0.5F, NAN, 0.5F});
    EXPECT_THAT(samples_of<float>(decode_xy_map(two, {0, 1}, Green::down, FlatCode::half, report)),
                ElementsAre(0, 0, 1, 0, 0, 1));
    EXPECT_EQ(report.count("normal without direction"), 1U);
    EXPECT_EQ(message_of<InvalidInput>([&] {
                  decode_xy_map(two, {0, 2}, Green::up, FlatCode::half, report);
              }),
              "there is no channel 3, but only 2");
}

/// Unit normals all over the sphere.
Image sphere() {
    std::vector<float> samples;
    for (int i = 0; i < 5000; ++i) {
        const double z = 1.0 - (2 * i + 1.0) / 5000.0;
        const double turn = 2.399963229728653 * i;
        const double across = std::sqrt(1.0 - z * z);
        for (const double part : {across * std::cos(turn), across * std::sin(turn), z})
            samples.push_back(static_cast<float>(part));
    }
    return image_of(3, std::move(samples));
}

TEST(CountLengths, RoundingAndDitheringAreWithinWhatCodesCanHold) {
    for (const FlatCode flat : both_codes) {
        for (const int bits : {8, 16, 32}) {
            for (const Dither dither : {Dither::none, Dither::ordered, Dither::blue_noise}) {
                Report report;
                const Image map =
                    encode_normal_map(sphere(), {bits, Green::up, flat, dither}, report);
                measure_lengths(map, flat, report);
                EXPECT_TRUE(report.empty()) << bits;
            }
        }
    }
}

TEST(CountLengths, CountsWhatNoCodeExplains) {
    // Lengths 100/127, (121, 39)/127 = 1.001, 0 and 1.41.
    const Image map =
        image_of<std::uint8_t>(3, {128, 128, 228, 128, 167, 249, 128, 128, 128, 255, 128, 255});
    Report report;
    const LengthRange spread = measure_lengths(map, FlatCode::middle, report);
    ASSERT_EQ(report.findings().size(), 1U);
    EXPECT_EQ(report.findings()[0].kind, "normal not of unit length");
    EXPECT_THAT(report.findings()[0].first, ElementsAre(0, 2, 3));
    EXPECT_EQ(spread.least, 0.0);
    EXPECT_NEAR(spread.greatest, std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(spread.mean,
                (100.0 / 127 + std::hypot(121.0, 39.0) / 127 + 0.0 + std::sqrt(2.0)) / 4, 1e-12);
    Image floats = image_of<float>(3, {NAN, 0.5F, 1.0F, 0.5F, 0.5F, 1.0F});
    Report of_floats;
    EXPECT_EQ(measure_lengths(floats, FlatCode::middle, of_floats).mean, 1.0);
    EXPECT_EQ(of_floats.count("normal not of unit length"), 1U);
}

TEST(ScaleSlopes, AreThoseOfMultipliedHeights) {
    const double slope_x = 0.5;
    const double slope_y = -1.25;
    for (const double strength : {0.0, 0.25, 1.0, 3.0, -2.0, 1e6}) {
        const glm::dvec3 unit = glm::normalize(glm::dvec3(-slope_x, -slope_y, 1.0));
        Image normals = image_of<float>(3, {static_cast<float>(unit.x), static_cast<float>(unit.y),
                                            static_cast<float>(unit.z)});
        Report report;
        scale_slopes(normals, strength, report);
        const auto n = normals.as<float>();
        EXPECT_LT(
            degrees_between({n[0], n[1], n[2]}, {-slope_x * strength, -slope_y * strength, 1.0}),
            1e-5);
        EXPECT_TRUE(report.empty());
    }
}

TEST(ScaleSlopes, NormalsWithoutSlopeAreCounted) {
    Image normals = image_of<float>(3, {1, 0, 0, 0.6F, 0, -0.8F, 0, 0, 1});
    Report report;
    scale_slopes(normals, 2.0, report);
    const auto n = normals.as<float>();
    EXPECT_THAT(std::vector<float>(n.begin(), n.begin() + 3), ElementsAre(1, 0, 0));
    EXPECT_LT(degrees_between({n[3], n[4], n[5]}, {1.2, 0, -0.8}), 1e-5);
    EXPECT_EQ(report.count("normal that does not face outwards"), 2U);
    EXPECT_EQ(report.count("normal without direction"), 0U);
    scale_slopes(normals, 0.0, report);
    EXPECT_THAT(samples_of<float>(normals), ElementsAre(0, 0, 1, 0, 0, -1, 0, 0, 1));
    EXPECT_EQ(report.count("normal without direction"), 1U);
    EXPECT_EQ(message_of<InvalidInput>([&] { scale_slopes(normals, NAN, report); }),
              "the strength nan is not within +-1000000");
}

TEST(SlopesFromNormals, AreFiniteForEveryNormal) {
    const float z = 1.0F / 2048.0F;
    const Image normals = image_of<float>(
        3, {-0.6F, 0, 0.8F, 0.6F, 0.8F, 0, 0, 0, -1, 0, -1, z, 0, 0.6F, -0.8F, 0, 0, 1});
    Report report;
    const Image slopes = slopes_from_normals(normals, report);
    EXPECT_THAT(samples_of<float>(slopes),
                ElementsAre(FloatEq(0.75F), 0, FloatEq(-614.4F), FloatEq(-819.2F), 0, 0, 0, 1024, 0,
                            -1024, 0, 0));
    EXPECT_EQ(report.count("normal too steep for a slope"), 4U);
    Report back_report;
    const Image back = normals_from_slopes(slopes, back_report);
    EXPECT_TRUE(back_report.empty());
    const auto n = back.as<float>();
    EXPECT_LT(degrees_between({n[0], n[1], n[2]}, {-0.6, 0, 0.8}), 1e-5);
    EXPECT_NEAR(degrees_between({n[3], n[4], n[5]}, {0.6, 0.8, 0.0}), 0.05595, 1e-4);
    EXPECT_THAT(std::vector<float>(n.end() - 3, n.end()), ElementsAre(0, 0, 1));
}

}  // namespace
}  // namespace relief
