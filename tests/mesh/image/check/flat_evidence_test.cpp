// SPDX-License-Identifier: Apache-2.0
// Pairs of codes counted by hand; then maps that are smooth, and raise no alarm, beside maps whose
// flat texels have another code than their file says, and do.
#include "image/map_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "relief/mesh/normal_map_check.h"

namespace relief {
namespace {

const std::map<std::string, std::string> says_128{{"relief:flat", "128"}};

Image codes(int side, std::uint8_t x, std::uint8_t y) {
    Image map = make_image(side, side, 3, 8, ColorSpace::data);
    for (std::size_t i = 0; i < map.sample_count(); ++i)
        map.as<std::uint8_t>()[i] = i % 3 == 0 ? x : i % 3 == 1 ? y : 255;
    return map;
}

/// Normals of a smooth surface from slopes by place, in 8 bits.
template <typename Slope>
Image smooth(int side, const Slope& slope) {
    Image normals = make_image(side, side, 3, 32, ColorSpace::data);
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const glm::dvec2 s = slope((x + 0.5) / side - 0.5, (y + 0.5) / side - 0.5);
            const glm::dvec3 normal = glm::normalize(glm::dvec3(s, 1.0));
            for (int i = 0; i < 3; ++i) {
                normals.as<float>()[static_cast<std::size_t>(3 * (y * side + x) + i)] =
                    static_cast<float>(normal[i]);
            }
        }
    }
    Report report;
    return encode_normal_map(normals, {.bits = 8, .flat = FlatCode::middle}, report);
}

TEST(FlatEvidence, CountsTexelsNearFlatAndThoseOfTheLowerCode) {
    Image map = codes(4, 127, 127);
    auto* samples = map.as<std::uint8_t>().data();
    samples[0] = 125;  // Too far off.
    samples[3] = 126;
    samples[7] = 129;
    samples[9] = samples[10] = 128;
    EXPECT_EQ(flat_evidence(map).near, 15U);
    EXPECT_EQ(flat_evidence(map).lower, 12U);
    EXPECT_FALSE(flat_evidence(map).is_half());  // Too few.
    EXPECT_EQ(flat_evidence(make_image(9, 9, 3, 32, ColorSpace::data)).near, 0U);
    Image wide = make_image(8, 8, 4, 16, ColorSpace::data);
    std::fill(wide.as<std::uint16_t>().begin(), wide.as<std::uint16_t>().end(), 32767);
    EXPECT_EQ(flat_evidence(wide).lower, 64U);
    EXPECT_TRUE(flat_evidence(wide).is_half());
}

TEST(FlatEvidence, ASmoothSurfaceRaisesNoAlarm) {
    for (const double steepness : {0.05, 0.2, 0.5, 1.0, 3.0}) {
        for (const double shift : {-0.3, -0.01, -0.004, 0.0, 0.003, 0.1}) {
            for (const int side : {64, 256}) {
                const Image map = smooth(side, [&](double x, double y) {
                    return glm::dvec2(steepness * (x + shift), steepness * (y - 0.7 * shift));
                });
                EXPECT_FALSE(check_normal_map(map, says_128).has(MapCondition::flat_contradicted))
                    << steepness << ' ' << shift << ' ' << side;
            }
        }
    }
}

TEST(FlatEvidence, FlatTexelsOfAnotherCodeAreFoundBesideCurvedOnes) {
    // A quarter flat, the rest a dome; what was written for flat is changed afterwards.
    for (const int side : {32, 64, 256}) {
        Image map = smooth(side, [](double x, double y) {
            return x < 0.0 && y < 0.0 ? glm::dvec2(0.0) : glm::dvec2(x, y);
        });
        EXPECT_FALSE(check_normal_map(map, says_128).has(MapCondition::flat_contradicted));
        auto* samples = map.as<std::uint8_t>().data();
        for (std::size_t i = 0; i + 2 < map.sample_count(); i += 3) {
            if (samples[i] == 128 && samples[i + 1] == 128) samples[i] = samples[i + 1] = 127;
        }
        EXPECT_TRUE(check_normal_map(map, says_128).has(MapCondition::flat_contradicted)) << side;
        EXPECT_FALSE(
            check_normal_map(map, {{"relief:flat", "127.5"}}).has(MapCondition::flat_contradicted));
        EXPECT_FALSE(check_normal_map(map).has(MapCondition::flat_contradicted));
    }
}

}  // namespace
}  // namespace relief
