// SPDX-License-Identifier: Apache-2.0
// Operations on normal maps: axis changes, reconstruction of z, normalization, slope scaling, and
// blending of a detail map.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "support/images.h"
#include "support/invariants.h"

namespace relief {
using namespace relief::accuracy;

namespace {

using test::image_of;
using test::message_of;
using test::samples_of;
using testing::ElementsAre;
using testing::FloatEq;

using test::both_codes;

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

TEST(MapAxes, PermuteDecodedVectors) {
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

TEST(MapAxes, RefusesInvalidPermutations) {
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

TEST(DecodeXyMap, ReconstructsZAndKeepsLongVectors) {
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

TEST(DecodeXyMap, ReadsAnyTwoChannelsInEitherGreen) {
    // x is in alpha and y in green, as in DXT5 normal maps.
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

/// Unit normals in all directions of the sphere.
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

TEST(CountLengths, RoundingAndDitheringAreNotCounted) {
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

TEST(CountLengths, CountsDeviationsBeyondRounding) {
    // Lengths 100/127, (121, 39)/127 = 1.001, 0 and 1.41.
    const Image map =
        image_of<std::uint8_t>(3, {128, 128, 228, 128, 167, 249, 128, 128, 128, 255, 128, 255});
    Report report;
    const LengthRange spread = measure_lengths(map, FlatCode::middle, report);
    ASSERT_EQ(report.findings().size(), 1U);
    EXPECT_EQ(report.findings()[0].kind, "normal not of unit length");
    EXPECT_THAT(report.findings()[0].first, ElementsAre(0, 2, 3));
    EXPECT_EQ(spread.min, 0.0);
    EXPECT_NEAR(spread.max, std::sqrt(2.0), 1e-12);
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
              "the strength is nan, but must be within +-1000000");
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

Image normal_image(int width, const std::vector<glm::dvec3>& directions) {
    Image image =
        make_image(width, static_cast<int>(directions.size()) / width, 3, 32, ColorSpace::data);
    for (std::size_t i = 0; i < directions.size(); ++i) {
        for (int c = 0; c < 3; ++c)
            image.as<float>()[i * 3 + static_cast<std::size_t>(c)] =
                static_cast<float>(glm::normalize(directions[i])[c]);
    }
    return image;
}

std::vector<glm::dvec3> directions_of(const Image& image) {
    std::vector<glm::dvec3> result;
    for (std::size_t i = 0; i < image.sample_count(); i += 3)
        result.emplace_back(image.as<float>()[i], image.as<float>()[i + 1],
                            image.as<float>()[i + 2]);
    return result;
}

glm::dvec3 blend_of(const glm::dvec3& base, const glm::dvec3& detail, NormalBlend method) {
    Image image = normal_image(1, {base});
    Report report;
    blend_normals(image, normal_image(1, {detail}), method, report);
    const glm::dvec3 result = directions_of(image)[0];
    EXPECT_EQ(report.count("blend without direction"), 0U);
    EXPECT_EQ(report.count("detail facing back on its base"),
              base.z >= 0 && result.z < 0 ? 1U : 0U);
    return result;
}

/// The resolution of a unit vector in floats.
constexpr double resolved_degrees = 1e-5;

std::vector<glm::dvec3> outward_directions() {
    std::vector<glm::dvec3> result;
    for (int i = 0; i < 40; ++i) {
        const double z = 1.0 - i / 40.0;
        const double across = std::sqrt(1.0 - z * z);
        result.emplace_back(across * std::cos(2.4 * i), across * std::sin(2.4 * i), z);
    }
    return result;
}

TEST(BlendNormals, PartialDerivativeIsTheSumOfTheHeights) {
    constexpr int side = 48;
    const std::vector<HeightWave> base_waves = tiling_waves(side, side, 4, 16, 1.0, 1);
    const std::vector<HeightWave> detail_waves = tiling_waves(side, side, 5, 6, 0.7, 2);
    std::vector<HeightWave> both = base_waves;
    both.insert(both.end(), detail_waves.begin(), detail_waves.end());
    Image image = normal_image(side, wave_heights(side, side, base_waves).normals);
    const Image detail = normal_image(side, wave_heights(side, side, detail_waves).normals);
    Report report;
    blend_normals(image, detail, NormalBlend::partial_derivative, report);
    EXPECT_LT(normal_error(image, wave_heights(side, side, both)).max, resolved_degrees);
    EXPECT_TRUE(report.empty());
}

TEST(BlendNormals, ReorientedIsTheShortestRotation) {
    for (const glm::dvec3& base : outward_directions()) {
        for (const glm::dvec3& detail : outward_directions()) {
            const glm::dquat turn(glm::dvec3(0, 0, 1), base);
            EXPECT_LT(
                degrees_between(blend_of(base, detail, NormalBlend::reoriented), turn * detail),
                resolved_degrees);
        }
    }
}

TEST(BlendNormals, UnityTurnsTheDetailsAxesOneByOne) {
    const glm::dvec3 b = glm::normalize(glm::dvec3(0.3, -0.2, 0.9));
    // The axes of the frame are the images of the axes of the detail.
    EXPECT_LT(degrees_between(blend_of(b, {0, 0, 1}, NormalBlend::unity), b), resolved_degrees);
    EXPECT_LT(degrees_between(blend_of(b, {1, 0, 0}, NormalBlend::unity), {b.z, b.y, -b.x}),
              resolved_degrees);
    EXPECT_LT(degrees_between(blend_of(b, {0, 1, 0}, NormalBlend::unity), {b.x, b.z, -b.y}),
              resolved_degrees);
}

TEST(BlendNormals, TheOthersAreTheirFormulas) {
    const glm::dvec3 base(0.6, 0.0, 0.8);
    const glm::dvec3 detail(0.0, -0.28, 0.96);
    const auto expect = [&](NormalBlend method, const glm::dvec3& expected) {
        EXPECT_LT(degrees_between(blend_of(base, detail, method), expected), resolved_degrees);
    };
    expect(NormalBlend::whiteout, {0.6, -0.28, 0.768});
    expect(NormalBlend::udn, {0.6, -0.28, 0.8});
    expect(NormalBlend::linear, {0.6, -0.28, 1.76});
    // (0.8, 0.5, 0.9) over (0.5, 0.36, 0.98): 1 - 2 * 0.2 * 0.5, 1 - 2 * 0.5 * 0.64, ...
    expect(NormalBlend::overlay, {0.6, -0.28, 0.992});
    // A dark base: 2 * 0.2 * 0.5.
    EXPECT_LT(degrees_between(blend_of({-0.6, 0, 0.8}, detail, NormalBlend::overlay),
                              {-0.6, -0.28, 0.992}),
              resolved_degrees);
}

TEST(BlendNormals, FlatIsNeutralForDocumentedMethods) {
    const glm::dvec3 flat(0, 0, 1);
    for (const NormalBlend method : all_normal_blends) {
        EXPECT_EQ(blend_of(flat, flat, method), flat);
        const bool halves = method == NormalBlend::linear || method == NormalBlend::overlay;
        for (const glm::dvec3& n : outward_directions()) {
            if (n.z < 0.5) continue;
            if (halves) continue;
            EXPECT_LT(degrees_between(blend_of(n, flat, method), n), resolved_degrees);
            if (method == NormalBlend::udn) continue;
            EXPECT_LT(degrees_between(blend_of(flat, n, method), n), resolved_degrees);
        }
    }
    EXPECT_LT(degrees_between(blend_of({0.6, 0, 0.8}, flat, NormalBlend::linear), {0.6, 0, 1.8}),
              resolved_degrees);
    EXPECT_LT(degrees_between(blend_of(flat, {0.6, 0, 0.8}, NormalBlend::udn), {0.6, 0, 1}),
              resolved_degrees);
}

TEST(BlendNormals, ASmallerDetailIsRepeatedAndALargerOneCutOff) {
    const Image detail = normal_image(2, {{0.6, 0, 0.8}, {0, 0.6, 0.8}, {-0.6, 0, 0.8}, {0, 0, 1}});
    const std::vector<glm::dvec3> pattern = directions_of(detail);
    Image base = normal_image(5, std::vector<glm::dvec3>(15, {0, 0, 1}));
    Report report;
    blend_normals(base, detail, NormalBlend::whiteout, report);
    const std::vector<glm::dvec3> result = directions_of(base);
    for (std::size_t y = 0; y < 3; ++y) {
        for (std::size_t x = 0; x < 5; ++x)
            EXPECT_LT(degrees_between(result[y * 5 + x], pattern[y % 2 * 2 + x % 2]),
                      resolved_degrees);
    }
    Image small = normal_image(1, {{0, 0, 1}});
    blend_normals(small, detail, NormalBlend::whiteout, report);
    EXPECT_LT(degrees_between(directions_of(small)[0], {0.6, 0, 0.8}), resolved_degrees);
}

TEST(BlendNormals, ZeroResultKeepsTheBaseAndIsCounted) {
    for (const auto& [method, base, detail] :
         {std::tuple{NormalBlend::reoriented, glm::dvec3(0, 0, -1), glm::dvec3(0.6, 0, 0.8)},
          std::tuple{NormalBlend::linear, glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0)},
          std::tuple{NormalBlend::whiteout, glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0)},
          std::tuple{NormalBlend::partial_derivative, glm::dvec3(1, 0, 0), glm::dvec3(1, 0, 0)}}) {
        Image image = normal_image(2, {{0, 0, 1}, base});
        Report report;
        blend_normals(image, normal_image(2, {{0, 0, 1}, detail}), method, report);
        EXPECT_EQ(directions_of(image)[1], base);
        EXPECT_EQ(report.count("blend without direction"), 1U);
        EXPECT_THAT(report.findings()[0].first, ElementsAre(1));
    }
}

TEST(BlendNormals, TheSameBitsForAnyNumberOfThreads) {
    const Image base =
        normal_image(300, wave_heights(300, 200, tiling_waves(300, 200, 6, 9, 1, 3)).normals);
    const Image detail =
        normal_image(37, wave_heights(37, 11, tiling_waves(37, 11, 3, 5, 1, 4)).normals);
    for (const NormalBlend method : all_normal_blends) {
        Report report;
        Image one = base;
        set_thread_limit(1);
        blend_normals(one, detail, method, report);
        set_thread_limit(0);
        Image many = base;
        blend_normals(many, detail, method, report);
        EXPECT_EQ(one.samples, many.samples);
    }
}

TEST(BlendNormals, RefusesInvalidImages) {
    Image base = normal_image(1, {{0, 0, 1}});
    Report report;
    const Image codes = make_image(2, 2, 3, 8, ColorSpace::data);
    EXPECT_EQ(test::message_of<InvalidInput>(
                  [&] { blend_normals(base, codes, NormalBlend::udn, report); }),
              "normals of a detail have 3 float channels, not 3 of 8 bits");
}

}  // namespace
}  // namespace relief
