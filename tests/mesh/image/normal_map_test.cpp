// SPDX-License-Identifier: Apache-2.0
// Codes of normal maps: exact flat codes, round trips by angle, and dithered codes whose mean is
// close to the exact value.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "relief/mesh/bump.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/image.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "support/images.h"
#include "support/invariants.h"

namespace relief {
namespace {

using test::samples_of;
using testing::ElementsAre;
using testing::Pair;
using testing::UnorderedElementsAre;

using test::both_codes;
using test::image_of;

/// Unit normals in all directions of the upper hemisphere.
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
    return image_of(3, std::move(samples));
}

/// Returns the largest angle in degrees between a normal and its decoded code.
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
    const Image axes = image_of<float>(3, {0, 0, 1, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0});
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
    const Image bytes = image_of<std::uint8_t>(3, {128, 128, 255});
    const Image words = image_of<std::uint16_t>(3, {32768, 32768, 65535});
    for (const Image& map : {bytes, words}) {
        EXPECT_THAT(
            samples_of<float>(decode_normal_map(map, Green::down, FlatCode::middle, report)),
            ElementsAre(0.0F, 0.0F, 1.0F));
    }
    // By the formula of glTF, the same texel has an angle of atan(sqrt(2) / 255).
    const Image leaning = decode_normal_map(bytes, Green::up, FlatCode::half, report);
    const std::span<const float> n = leaning.as<float>();
    EXPECT_NEAR(test::degrees_between(glm::dvec3(n[0], n[1], n[2]), {0, 0, 1}), 0.3178, 1e-4);
}

TEST(NormalMap, FloatMapsHoldHalfThePlusOneAndFlatIsExact) {
    Report report;
    const Image map = encode_normal_map(image_of<float>(3, {0.6F, 0, 0.8F, 0, 0, 1}), {32}, report);
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

TEST(NormalMap, RoundTripIsWithinHalfACode) {
    // Half a code in three components: at most atan(sqrt(3) / 2 * 2 / 254), and similar for other
    // formats.
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
    const Image map = image_of<std::uint8_t>(3, {150, 200, 220});
    const Image up = decode_normal_map(map, Green::up, FlatCode::middle, report);
    const Image down = decode_normal_map(map, Green::down, FlatCode::middle, report);
    EXPECT_EQ(up.as<float>()[0], down.as<float>()[0]);
    EXPECT_EQ(up.as<float>()[1], -down.as<float>()[1]);
    EXPECT_GT(up.as<float>()[1], 0.0F);
}

TEST(NormalMap, AFourthChannelIsIgnoredAndCodeZeroIsMinusOne) {
    Report report;
    const Image map = image_of<std::uint8_t>(4, {0, 128, 128, 3, 128, 128, 255, 200});
    EXPECT_THAT(samples_of<float>(decode_normal_map(map, Green::up, FlatCode::middle, report)),
                ElementsAre(-1.0F, 0.0F, 0.0F, 0.0F, 0.0F, 1.0F));
    EXPECT_TRUE(report.empty());
}

TEST(NormalMap, ZeroVectorsBecomeFlatAndAreCounted) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    Report stored;
    const Image map = encode_normal_map(
        image_of<float>(3, {0, 0, 0, nan, 0, 1, 0, 0, 1, infinity, 0, 1}), {8}, stored);
    EXPECT_THAT(map.as<std::uint8_t>(),
                ElementsAre(128, 128, 255, 128, 128, 255, 128, 128, 255, 128, 128, 255));
    ASSERT_EQ(stored.findings().size(), 1U);
    EXPECT_EQ(stored.findings()[0],
              (Finding{"normal without direction", "texel", "stored as flat", 3, {0, 1, 3}}));
    Report read;
    const Image back = decode_normal_map(image_of<std::uint8_t>(3, {128, 128, 128}), Green::up,
                                         FlatCode::middle, read);
    EXPECT_THAT(back.as<float>(), ElementsAre(0.0F, 0.0F, 1.0F));
    EXPECT_EQ(read.count("normal without direction"), 1U);
}

TEST(NormalMap, OnlyTheDirectionCounts) {
    Report report;
    for (const float length : {1e-30F, 0.5F, 2.0F, 1e30F}) {
        const Image map = encode_normal_map(image_of<float>(3, {0.6F * length, 0, 0.8F * length}),
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
    EXPECT_THROW(encode_normal_map(image_of<float>(3, {0, 0, 1}), {12}, report), InvalidInput);
    const Image gray = make_image(1, 1, 2, 8, ColorSpace::data);
    EXPECT_THROW(decode_normal_map(gray, Green::up, FlatCode::half, report), InvalidInput);
    EXPECT_THROW(detect_flat_code(gray), InvalidInput);
    EXPECT_THROW(detect_flat_code(Image{}), InvalidInput);
}

TEST(NormalMap, ZeroFollowsTheMetadataElseGltf) {
    const Image lower = image_of<std::uint8_t>(3, {127, 127, 255, 127, 128, 255, 10, 128, 200});
    const Image upper = image_of<std::uint8_t>(3, {128, 128, 255, 127, 128, 255, 127, 10, 200});
    EXPECT_EQ(detect_flat_code(lower), FlatCode::half);
    EXPECT_EQ(detect_flat_code(upper), FlatCode::half);
    EXPECT_EQ(detect_flat_code(image_of<std::uint16_t>(3, {32768, 32768, 65535})), FlatCode::half);
    EXPECT_EQ(detect_flat_code(upper, {{"relief:flat", "127.5"}}), FlatCode::half);
    EXPECT_EQ(detect_flat_code(lower, {{"relief:flat", "128"}}), FlatCode::middle);
    EXPECT_EQ(detect_flat_code(lower, {{"relief:flat", "32768"}}), FlatCode::middle);
    EXPECT_EQ(detect_flat_code(upper, {{"relief:flat", "what?"}}), FlatCode::half);
}

TEST(NormalMap, DefaultIsTheDecodingOfGltf) {
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
            const glm::dvec3 reference(normals.as<float>()[first], normals.as<float>()[first + 1],
                                       normals.as<float>()[first + 2]);
            largest = std::max(
                largest, test::degrees_between({decoded(0), decoded(1), decoded(2)}, reference));
        }
        // Half a code in three components, without the error of another zero.
        EXPECT_LT(largest, bits == 8 ? 0.395 : 0.0016);
    }
}

TEST(NormalMap, FlatIsExactlyFlatUnderBothZeros) {
    // A flat quarter beside normals in all directions.
    Image normals = hemisphere();
    const std::size_t flat_samples = normals.sample_count() / 3 / 4 * 3;
    for (std::size_t i = 0; i < flat_samples; ++i)
        normals.as<float>()[i] = i % 3 == 2 ? 1.0F : 0.0F;
    Report report;
    for (const FlatCode flat : both_codes) {
        for (const int bits : {8, 16}) {
            for (const Green green : {Green::up, Green::down}) {
                Image map = encode_normal_map(normals, {bits, green, flat}, report);
                if (green == Green::down)  // The codes are reversed: 128 becomes 127.
                    map_axes(map, {{{0, false}, {1, true}, {2, false}}}, flat, report);
                const Image exact =
                    decode_normal_map(map, Green::up, flat, report, FlatTexels::exact);
                const Image as_coded = decode_normal_map(map, Green::up, flat, report);
                for (std::size_t i = 0; i < flat_samples; ++i)
                    ASSERT_EQ(exact.as<float>()[i], i % 3 == 2 ? 1.0F : 0.0F);
                // All other samples follow the formula.
                for (std::size_t i = flat_samples; i < normals.sample_count(); ++i)
                    ASSERT_NEAR(exact.as<float>()[i], as_coded.as<float>()[i], 0.004F);
                EXPECT_EQ(flat_texel_codes(map).has_value(), true);
            }
        }
    }
    EXPECT_TRUE(report.empty());
}

TEST(NormalMap, FlatCodesNeedAPrevailingPair) {
    EXPECT_THAT(flat_texel_codes(image_of<std::uint8_t>(3, {128, 127, 255, 9, 128, 200})).value(),
                ElementsAre(128, 127));
    EXPECT_THAT(flat_texel_codes(image_of<std::uint16_t>(3, {32767, 32767, 65535})).value(),
                ElementsAre(32767, 32767));
    EXPECT_THAT(flat_texel_codes(image_of<std::uint8_t>(3, {128, 9, 128}), 0, 2).value(),
                ElementsAre(128, 128));
    // Three of four codes, and fewer.
    EXPECT_TRUE(
        flat_texel_codes(image_of<std::uint8_t>(2, {128, 128, 128, 128, 127, 128, 128, 128})));
    EXPECT_FALSE(flat_texel_codes(image_of<std::uint8_t>(2, {128, 128, 128, 128, 127, 128})));
    EXPECT_FALSE(flat_texel_codes(image_of<std::uint8_t>(2, {126, 128, 128, 129})));
    EXPECT_FALSE(flat_texel_codes(image_of<float>(3, {0.5F, 0.5F, 1.0F})));
    EXPECT_THROW(flat_texel_codes(Image{}), InvalidInput);
    EXPECT_THROW(flat_texel_codes(image_of<std::uint8_t>(2, {1, 2}), 0, 2), InvalidInput);
    // Dithered flat ground: each of the four pairs is a separate direction.
    std::vector<float> flat;
    for (int i = 0; i < 64 * 64; ++i)
        flat.insert(flat.end(), {0.0F, 0.0F, 1.0F});
    Image normals = image_of(3, std::move(flat));
    normals.width = normals.height = 64;
    Report report;
    for (const Dither dither : {Dither::ordered, Dither::blue_noise}) {
        EXPECT_FALSE(flat_texel_codes(
            encode_normal_map(normals, {8, Green::up, FlatCode::half, dither}, report)));
    }
}

TEST(NormalMap, MetadataRoundTrips) {
    EXPECT_THAT(normal_map_metadata({16, Green::down, FlatCode::middle}),
                UnorderedElementsAre(Pair("relief:content", "normal map, tangent space"),
                                     Pair("relief:green", "down"), Pair("relief:flat", "32768"),
                                     Pair("relief:color-space", "data")));
    EXPECT_EQ(normal_map_metadata({16, Green::up, FlatCode::half}).at("relief:flat"), "32767.5");
    EXPECT_EQ(normal_map_metadata({8, Green::up, FlatCode::middle}).at("relief:flat"), "128");
    EXPECT_EQ(normal_map_metadata({32, Green::up, FlatCode::half}).at("relief:flat"), "0.5");
    const Image any = image_of<std::uint8_t>(3, {1, 2, 3});
    for (const int bits : {8, 16}) {
        for (const FlatCode flat : both_codes)
            EXPECT_EQ(detect_flat_code(any, normal_map_metadata({bits, Green::up, flat})), flat);
    }
}

constexpr Dither both_dithers[] = {Dither::ordered, Dither::blue_noise};

int side_of(Dither dither) {
    return dither == Dither::ordered ? 16 : 64;
}

/// A patch of one direction with the size of the largest tile.
constexpr int patch = 64;

Image patch_of(const glm::dvec3& direction) {
    Image image = make_image(patch, patch, 3, 32, ColorSpace::data);
    const auto samples = image.as<float>();
    const glm::dvec3 unit = glm::normalize(direction);
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = static_cast<float>(unit[static_cast<int>(i % 3)]);
    return image;
}

/// Directions in the hemisphere without special ones.
std::vector<glm::dvec3> directions() {
    std::vector<glm::dvec3> result;
    for (int i = 0; i < 24; ++i) {
        const double tilt = 0.06 * (i + 0.7);
        const double turn = 2.4 * i;
        result.emplace_back(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn),
                            std::cos(tilt));
    }
    return result;
}

/// Returns the error in degrees of the direction of the mean of the codes of a patch.
double degrees_of_mean(const glm::dvec3& direction, const NormalMapFormat& format) {
    Report report;
    const Image map = decode_normal_map(encode_normal_map(patch_of(direction), format, report),
                                        format.green, format.flat, report);
    glm::dvec3 sum{};
    for (std::size_t i = 0; i < map.sample_count(); ++i)
        sum[static_cast<int>(i % 3)] += static_cast<double>(map.as<float>()[i]);
    return degrees_between(sum, direction);
}

TEST(Dither, EveryThresholdComesOnceATileInEachChannel) {
    for (const Dither dither : both_dithers) {
        const int side = side_of(dither);
        for (int channel = 0; channel < 3; ++channel) {
            std::set<float> seen;
            for (int y = 0; y < side; ++y) {
                for (int x = 0; x < side; ++x) {
                    const float threshold = dither_threshold(dither, x, y, channel);
                    EXPECT_EQ(threshold, dither_threshold(dither, x + side, y + 5 * side, channel));
                    seen.insert(threshold);
                }
            }
            const auto count = static_cast<float>(side * side);
            EXPECT_EQ(static_cast<float>(seen.size()), count);
            EXPECT_EQ(*seen.begin(), 0.5F / count);
            EXPECT_EQ(*seen.rbegin(), (count - 0.5F) / count);
        }
    }
}

TEST(Dither, TheTilesAreTheSameEverywhere) {
    // FNV-1a over the ranks in reading order. The hash is fixed, because dithered files must not
    // change.
    const auto hash_of = [](Dither dither) {
        const int side = side_of(dither);
        std::uint32_t hash = 2166136261U;
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                const float rank =
                    dither_threshold(dither, x, y, 0) * static_cast<float>(side * side);
                hash = (hash ^ static_cast<std::uint32_t>(rank)) * 16777619U;
            }
        }
        return hash;
    };
    EXPECT_EQ(hash_of(Dither::ordered), 2707748165U);
    EXPECT_EQ(hash_of(Dither::blue_noise), 1705268161U);
    EXPECT_EQ(dither_threshold(Dither::ordered, 0, 0, 0) * 256, 0.5F);
    EXPECT_EQ(dither_threshold(Dither::ordered, 1, 1, 0) * 256, 64.5F);
    EXPECT_EQ(dither_threshold(Dither::ordered, 1, 0, 0) * 256, 128.5F);
    EXPECT_EQ(dither_threshold(Dither::ordered, 0, 1, 0) * 256, 192.5F);
}

/// Returns the power of a tile in waves of this range of periods per tile, as a share of that of
/// white noise.
double power(Dither dither, double from, double to) {
    const int side = side_of(dither);
    double sum = 0.0;
    int waves = 0;
    for (int v = -side / 2; v < side / 2; ++v) {
        for (int u = 0; u < side / 2; ++u) {
            const double frequency = std::hypot(u, v);
            if (frequency < from || frequency >= to) continue;
            double real = 0.0;
            double imaginary = 0.0;
            for (int y = 0; y < side; ++y) {
                for (int x = 0; x < side; ++x) {
                    const double phase = 2.0 * 3.14159265358979 * (u * x + v * y) / side;
                    const double value =
                        static_cast<double>(dither_threshold(dither, x, y, 0)) - 0.5;
                    real += value * std::cos(phase);
                    imaginary += value * std::sin(phase);
                }
            }
            sum += (real * real + imaginary * imaginary) / (side * side) * 12.0;
            ++waves;
        }
    }
    return sum / waves;
}

TEST(Dither, BlueNoiseHasNextToNoLowFrequencies) {
    // White noise has 1 everywhere.
    EXPECT_LT(power(Dither::blue_noise, 1, 8), 0.0004);
    EXPECT_GT(power(Dither::blue_noise, 28, 32), 1.5);
}

TEST(Dither, TheChannelsOfBlueNoiseHaveNextToNoCorrelation) {
    constexpr int side = 64;
    for (const auto& [a, b] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
        double sum = 0.0;
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                const auto at = [&](int channel) {
                    return static_cast<double>(dither_threshold(Dither::blue_noise, x, y, channel));
                };
                sum += (at(a) - 0.5) * (at(b) - 0.5);
            }
        }
        EXPECT_NEAR(sum / (side * side) * 12.0, 0.0, 0.03) << a << " " << b;
    }
}

TEST(Dither, KeepsExactCodes) {
    // The flat direction and the axes.
    for (const Dither dither : both_dithers) {
        for (const int bits : {8, 16}) {
            for (const glm::dvec3& axis :
                 {glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0)}) {
                Report report;
                const NormalMapFormat plain{bits, Green::up, FlatCode::middle};
                NormalMapFormat dithered = plain;
                dithered.dither = dither;
                EXPECT_EQ(encode_normal_map(patch_of(axis), dithered, report).samples,
                          encode_normal_map(patch_of(axis), plain, report).samples);
            }
        }
    }
}

/// Returns the root mean square over many directions.
double rms_of_means(const NormalMapFormat& format) {
    double squares = 0.0;
    for (const glm::dvec3& direction : directions())
        squares += std::pow(degrees_of_mean(direction, format), 2);
    return std::sqrt(squares / static_cast<double>(directions().size()));
}

TEST(Dither, MeanOfAPatchIsMoreAccurateThanOneCode) {
    // Measured: 0.178 degrees at 8 bits and 0.00070 at 16; ordered dither is 237 times more
    // accurate, blue noise 1000 times.
    for (const FlatCode flat : {FlatCode::middle, FlatCode::half}) {
        for (const int bits : {8, 16}) {
            const double nearest = rms_of_means({bits, Green::up, flat});
            EXPECT_NEAR(nearest, bits == 8 ? 0.178 : 0.00070, bits == 8 ? 0.005 : 0.00005);
            EXPECT_LT(rms_of_means({bits, Green::up, flat, Dither::ordered}), nearest / 200);
            EXPECT_LT(rms_of_means({bits, Green::up, flat, Dither::blue_noise}), nearest / 800);
        }
    }
}

TEST(Dither, HalfCodesAreFlatInTheMean) {
    for (const Dither dither : both_dithers)
        EXPECT_LT(degrees_of_mean({0, 0, 1}, {8, Green::up, FlatCode::half, dither}), 1e-5);
    EXPECT_NEAR(degrees_of_mean({0, 0, 1}, {8, Green::up, FlatCode::half}), 0.3178, 1e-4);
}

/// Checks the value in steps of codes and the stored code for each sample of a patch.
template <typename Code>
double largest_code_error(const Image& normals, const NormalMapFormat& format) {
    Report report;
    const std::vector<Code> codes = samples_of<Code>(encode_normal_map(normals, format, report));
    const double top = std::numeric_limits<Code>::max();
    const double zero = format.flat == FlatCode::middle ? (top + 1) / 2 : top / 2;
    const double steps = format.flat == FlatCode::middle ? (top - 1) / 2 : top / 2;
    double largest = 0.0;
    for (std::size_t i = 0; i < codes.size(); ++i) {
        const double exact = zero + steps * static_cast<double>(normals.as<float>()[i]);
        largest = std::max(largest, std::abs(codes[i] - exact));
    }
    return largest;
}

TEST(Dither, IsWithinOneCode) {
    for (const glm::dvec3& direction : directions()) {
        for (const FlatCode flat : {FlatCode::middle, FlatCode::half}) {
            for (const Dither dither : both_dithers) {
                const Image normals = patch_of(direction);
                EXPECT_LT(largest_code_error<std::uint8_t>(normals, {8, Green::up, flat, dither}),
                          1.0);
                EXPECT_LT(largest_code_error<std::uint16_t>(normals, {16, Green::up, flat, dither}),
                          1.004);  // The length of the float normal has an error of 1e-7 of 32767.
            }
        }
    }
}

TEST(Dither, OppositeSlopesHaveMirroredCodes) {
    for (const Dither dither : both_dithers) {
        const NormalMapFormat format{8, Green::up, FlatCode::middle, dither};
        Report report;
        for (const glm::dvec3& n : directions()) {
            const auto a = samples_of<std::uint8_t>(encode_normal_map(patch_of(n), format, report));
            const auto b = samples_of<std::uint8_t>(
                encode_normal_map(patch_of({-n.x, -n.y, n.z}), format, report));
            for (std::size_t i = 0; i < a.size(); ++i)
                ASSERT_EQ(a[i] + b[i], i % 3 == 2 ? 2 * a[i] : 256);
        }
    }
}

TEST(Dither, HeightsGoToTheSameCodesAsTheirNormals) {
    const Image heights = test::rough(150, 70);
    BumpOptions options;
    options.arithmetic = Arithmetic::float64;
    options = resolve_options(heights, options);  // Choosing the kernel takes most of the time.
    for (const Dither dither : both_dithers) {
        for (const int bits : {8, 16}) {
            for (const FlatCode flat : {FlatCode::middle, FlatCode::half}) {
                const NormalMapFormat format{bits, Green::down, flat, dither};
                Report report;
                const Image normals = normals_from_height(heights, options, report);
                const Image expected = to_float(encode_normal_map(normals, format, report));
                set_thread_limit(1);
                const Image exact = normal_map_from_height(heights, options, format, report);
                set_thread_limit(0);
                EXPECT_EQ(normal_map_from_height(heights, options, format, report).samples,
                          exact.samples);
                const Image codes = to_float(exact);
                std::size_t different = 0;
                for (std::size_t i = 0; i < codes.sample_count(); ++i)
                    different += codes.as<float>()[i] == expected.as<float>()[i] ? 0 : 1;
                // Normals are rounded to float before encoding.
                EXPECT_LE(different, codes.sample_count() / (bits == 8 ? 10000 : 200));
            }
        }
    }
}

}  // namespace
}  // namespace relief
