// SPDX-License-Identifier: Apache-2.0
// Dithered codes: what a code says exactly keeps it, the mean of a patch is nearer to the truth
// than any one code, nothing is a whole code off; and the tiles are what they are called.
#include "relief/mesh/dither.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "relief/mesh/bump.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/threads.h"
#include "support/height_fields.h"
#include "support/samples.h"

namespace relief {
namespace {

using test::samples_of;

constexpr Dither both_dithers[] = {Dither::ordered, Dither::blue_noise};

int side_of(Dither dither) {
    return dither == Dither::ordered ? 16 : 64;
}

/// A patch of one direction, as large as the largest tile.
constexpr int patch = 64;

Image patch_of(const glm::dvec3& direction) {
    Image image = make_image(patch, patch, 3, 32, ColorSpace::data);
    const auto samples = image.as<float>();
    const glm::dvec3 unit = glm::normalize(direction);
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = static_cast<float>(unit[static_cast<int>(i % 3)]);
    return image;
}

/// Directions all over the hemisphere, none of them special.
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

/// The direction of the mean of a patch's codes, and how far it is from the truth in degrees.
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
    // FNV-1a over the ranks in reading order: fixed, for files made by dithering must not change.
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

/// Share of the power of white noise that a tile has in waves of so many periods a tile.
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

TEST(Dither, WhatACodeSaysExactlyKeepsThatCode) {
    // Flat, and the axes.
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

/// Root mean square over many directions.
double rms_of_means(const NormalMapFormat& format) {
    double squares = 0.0;
    for (const glm::dvec3& direction : directions())
        squares += std::pow(degrees_of_mean(direction, format), 2);
    return std::sqrt(squares / static_cast<double>(directions().size()));
}

TEST(Dither, TheMeanOfAPatchIsNearerToTheTruthThanItsNearestCode) {
    // Measured: 0.178 degrees at 8 bits, 0.00070 at 16; ordered 237 times nearer, blue noise 1000.
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

/// Steps of codes that a component is, and what code was stored, for each sample of a patch.
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

TEST(Dither, NothingIsAWholeCodeOff) {
    for (const glm::dvec3& direction : directions()) {
        for (const FlatCode flat : {FlatCode::middle, FlatCode::half}) {
            for (const Dither dither : both_dithers) {
                const Image normals = patch_of(direction);
                EXPECT_LT(largest_code_error<std::uint8_t>(normals, {8, Green::up, flat, dither}),
                          1.0);
                EXPECT_LT(largest_code_error<std::uint16_t>(normals, {16, Green::up, flat, dither}),
                          1.004);  // The float normal's length is off by 1e-7 of 32767.
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
    for (const Dither dither : both_dithers) {
        for (const int bits : {8, 16}) {
            for (const FlatCode flat : {FlatCode::middle, FlatCode::half}) {
                const NormalMapFormat format{bits, Green::down, flat, dither};
                BumpOptions options;
                options.arithmetic = Arithmetic::float64;
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
                // Normals are rounded to float before they are coded.
                EXPECT_LE(different, codes.sample_count() / (bits == 8 ? 10000 : 200));
            }
        }
    }
}

}  // namespace
}  // namespace relief
