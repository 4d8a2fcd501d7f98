// SPDX-License-Identifier: Apache-2.0
// Numbers of layers as codes: zero exact, ends, what is beyond them.
#include "mesh/layer_coding.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace relief::tools {
namespace {

template <typename Sample>
std::vector<Sample> codes(const LayerCoding& coding, const std::vector<float>& values,
                          Report& report, bool has_alpha = false) {
    std::vector<TexelState> states(values.size() / coding.channels(), TexelState::baked);
    states.back() = TexelState::empty;
    const std::vector<std::byte> bytes =
        coded_layer(values, states, coding, has_alpha, 100, report);
    std::vector<Sample> samples(bytes.size() / sizeof(Sample));
    std::memcpy(samples.data(), bytes.data(), bytes.size());
    return samples;
}

TEST(LayerCoding, ZeroIsTheMiddleCodeAndSignsAreMirrored) {
    Report report;
    const std::vector<float> heights = {0.0F, 0.5F, -0.5F, 0.25F, -0.25F};
    EXPECT_EQ(codes<std::uint16_t>({LayerKind::height, 16, 0.5}, heights, report),
              (std::vector<std::uint16_t>{32768, 65535, 1, 49152, 16384}));
    EXPECT_EQ(codes<std::uint8_t>({LayerKind::curvature, 8, 0.5}, heights, report),
              (std::vector<std::uint8_t>{128, 255, 1, 192, 64}));
    EXPECT_EQ(codes<float>({LayerKind::height, 32, 0.5}, heights, report), heights);
    EXPECT_EQ(codes<std::uint16_t>({LayerKind::position, 16, 2.0}, {0.0F, 1.0F, -2.0F}, report),
              (std::vector<std::uint16_t>{32768, 49152, 1}));
    EXPECT_TRUE(report.empty());
    // What a displacement makes of a code is the height.
    for (const int bits : {8, 16}) {
        const LayerCoding coding{LayerKind::height, bits, 0.5};
        const double largest = bits == 8 ? 255.0 : 65535.0;
        const double zero = coding.zero_code();
        EXPECT_NEAR((zero / largest - coding.midlevel()) * coding.strength(), 0.0, 1e-15);
        EXPECT_NEAR((1.0 - coding.midlevel()) * coding.strength(), 0.5, 1e-15);
        EXPECT_NEAR((1.0 / largest - coding.midlevel()) * coding.strength(), -0.5, 1e-15);
    }
}

TEST(LayerCoding, OcclusionIsPlainAndColoursAreCoded) {
    Report report;
    EXPECT_EQ(codes<std::uint8_t>({LayerKind::occlusion, 8, 1.0}, {0.0F, 0.5F, 1.0F}, report),
              (std::vector<std::uint8_t>{0, 128, 255}));
    EXPECT_EQ(codes<std::uint8_t>({LayerKind::color, 8, 1.0}, {0.0F, 0.5F, 1.0F}, report),
              (std::vector<std::uint8_t>{0, 188, 255}));
    EXPECT_EQ(codes<std::uint8_t>({LayerKind::occlusion, 8, 1.0}, {1.0F, 0.5F}, report, true),
              (std::vector<std::uint8_t>{255, 255, 128, 0}));
    EXPECT_EQ(codes<float>({LayerKind::color, 32, 1.0}, {0.0F, 0.5F, 7.0F}, report, true),
              (std::vector<float>{0.0F, 0.5F, 7.0F, 0.0F}));
    EXPECT_TRUE(report.empty());
}

TEST(LayerCoding, CountsWhatIsBeyondTheRange) {
    Report report;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(
        codes<std::uint8_t>({LayerKind::height, 8, 0.5}, {0.6F, -infinity, nan, 0.1F}, report),
        (std::vector<std::uint8_t>{255, 1, 128, 153}));
    EXPECT_EQ(report.count("height map beyond what its file holds"), 3U);
    EXPECT_EQ(report.findings()[0].first, (std::vector<std::size_t>{100, 101, 102}));
    EXPECT_EQ(codes<std::uint8_t>({LayerKind::color, 8, 1.0}, {1.5F, -0.1F, 1.0F}, report),
              (std::vector<std::uint8_t>{255, 0, 255}));
    EXPECT_EQ(report.count("colours beyond what its file holds"), 1U);
}

}  // namespace
}  // namespace relief::tools
