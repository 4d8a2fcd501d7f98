// SPDX-License-Identifier: Apache-2.0
// Statistics of height maps, on fields made for it and on real ones.
#include "relief/mesh/height_statistics.h"
#include "relief/mesh/height_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "relief/mesh/analytic_heights.h"
#include "relief/mesh/error.h"
#include "relief/mesh/image_file.h"
#include "support/height_fields.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using test::heights_of;

/// The same codes, each times `factor` plus `offset`, in 16 bits.
Image widened(const Image& codes, int factor, int offset) {
    Image wide = make_image(codes.width, codes.height, 1, 16, ColorSpace::data);
    for (std::size_t i = 0; i < codes.sample_count(); ++i)
        wide.as<std::uint16_t>()[i] =
            static_cast<std::uint16_t>(codes.as<std::uint8_t>()[i] * factor + offset);
    return wide;
}

CodedHeights waves(int bits) {
    return coded_heights(wave_heights(96, 64, tiling_waves(96, 64, 12, 16.0, 0.3, 2)).heights,
                         bits);
}

TEST(Tiling, WavesThatTileDoAndARampDoesNot) {
    for (const int bits : {8, 16}) {
        const CodedHeights coded = waves(bits);
        const Tiling tiling = detect_tiling(coded.codes);
        EXPECT_LT(tiling.seam_x, 1.1);
        EXPECT_LT(tiling.seam_y, 1.1);
        EXPECT_EQ(tiling.wraps(), Wraps(Wrap::repeat));
    }
    // 3 a column over 32 of them: the seam falls by 93 where neighbours differ by 3.
    const Tiling ramp = detect_tiling(heights_of(32, 8, [](int x, int) { return 3.0 * x; }));
    EXPECT_NEAR(ramp.seam_x, 31.0, 1e-6);
    EXPECT_EQ(ramp.seam_y, 0.0);
    EXPECT_EQ(ramp.wraps(), Wraps(Wrap::clamp, Wrap::repeat));
}

TEST(Tiling, APartOfATilingMapDoesNotTile) {
    const AnalyticHeights whole = wave_heights(128, 128, tiling_waves(128, 128, 12, 32.0, 0.3, 4));
    const Image part = heights_of(90, 128, [&](int x, int y) {
        return whole.heights.as<float>()[static_cast<std::size_t>(y * 128 + x)];
    });
    EXPECT_GT(detect_tiling(part).seam_x, 3.0);
    EXPECT_LT(detect_tiling(part).seam_y, 1.1);
}

TEST(Tiling, NothingToCompareWithAndHoles) {
    EXPECT_TRUE(detect_tiling(heights_of(1, 1, [](int, int) { return 2.0; })).tiles_x());
    EXPECT_TRUE(detect_tiling(heights_of(4, 4, [](int, int) { return 2.0; })).tiles_y());
    Image step = heights_of(4, 4, [](int x, int) { return x == 3 ? 1.0 : 0.0; });
    EXPECT_EQ(detect_tiling(step).seam_x, 1.0);
    step.as<float>()[3] = std::numeric_limits<float>::infinity();
    step.as<float>()[5] = std::nanf("");
    EXPECT_EQ(detect_tiling(step).seam_x, 1.0);
    EXPECT_THROW(detect_tiling(Image{}), InvalidInput);
    EXPECT_THROW(detect_tiling(make_image(2, 2, 3, 8, ColorSpace::data)), InvalidInput);
}

TEST(Tiling, OfRealMaps) {
    RELIEF_NEEDS_SHARED(folder, "data/textures");
    const auto tiling = [&](const char* name) {
        return detect_tiling(height_field(read_image(folder / name, ImageUse::data)));
    };
    for (const char* name :
         {"sand_ambientcg/sand_depth.png", "cheese_godot/texture_cheese_depth.png",
          "height_only/hexMap_height_1024_u16.png"})
        EXPECT_EQ(tiling(name).wraps(), Wraps(Wrap::repeat)) << name;
    EXPECT_EQ(tiling("height_only/Canyon-Height_4096_u8.jpg").wraps(), Wraps(Wrap::clamp));
}

TEST(HeightDepth, IsThatOfTheValuesNotOfTheFile) {
    const Image narrow = waves(8).codes;
    EXPECT_EQ(height_depth(narrow).bits, 8);
    EXPECT_DOUBLE_EQ(height_depth(narrow).step, 1.0 / 255.0);
    EXPECT_EQ(height_depth(widened(narrow, 257, 0)).bits, 8);
    EXPECT_DOUBLE_EQ(height_depth(widened(narrow, 257, 0)).step, 1.0 / 255.0);
    EXPECT_EQ(height_depth(widened(narrow, 256, 0)).bits, 8);
    EXPECT_DOUBLE_EQ(height_depth(widened(narrow, 100, 77)).step, 100.0 / 65535.0);
    EXPECT_EQ(height_depth(waves(16).codes).bits, 16);
    EXPECT_EQ(height_depth(height_field(narrow)).bits, 8);
    EXPECT_EQ(height_depth(height_field(waves(16).codes)).bits, 16);
    Image colors = make_image(64, 64, 3, 8, ColorSpace::data);
    for (std::size_t i = 0; i < colors.sample_count(); ++i)
        colors.as<std::uint8_t>()[i] = static_cast<std::uint8_t>(i * i % 251);
    EXPECT_EQ(height_depth(height_field(colors)).bits, 10);
    EXPECT_DOUBLE_EQ(height_depth(height_field(colors)).step, 1.0 / 765.0);
    EXPECT_EQ(
        height_depth(wave_heights(96, 64, tiling_waves(96, 64, 12, 16.0, 0.3, 2)).heights).bits, 0);
    EXPECT_EQ(height_depth(heights_of(3, 3, [](int, int) { return 0.4; })).bits, 1);
    Image black_and_white = make_image(2, 1, 1, 16, ColorSpace::data);
    black_and_white.as<std::uint16_t>()[1] = 65535;
    EXPECT_EQ(height_depth(black_and_white).bits, 1);
}

TEST(HeightNoise, IsTheDeviationOfNoiseOnASmoothMap) {
    std::uint32_t state = 99;
    const auto uniform = [&] {
        state = state * 1664525U + 1013904223U;
        return static_cast<double>(state >> 8) / 16777216.0;
    };
    // Sums of 12 uniform numbers: Gaussian of deviation 1.
    const auto gaussian = [&] {
        double sum = -6.0;
        for (int i = 0; i < 12; ++i)
            sum += uniform();
        return sum;
    };
    const double k = 2.0 * 3.14159265358979 / 64.0;
    const auto smooth = [&](int x, int y) { return std::sin(k * x) * std::cos(k * y); };
    for (const double deviation : {0.002, 0.02}) {
        const Image noisy = heights_of(
            300, 300, [&](int x, int y) { return smooth(x, y) + deviation * gaussian(); });
        // 90,000 texels, 9 of which share a value: 1 %.
        EXPECT_NEAR(height_noise(noisy), deviation, 0.03 * deviation);
    }
    // What is left of the waves: k^4 / 4 of them, through |.| and the factor.
    EXPECT_LT(height_noise(heights_of(300, 300, smooth)), 2e-5);
    EXPECT_EQ(height_noise(heights_of(2, 9, smooth)), 0.0);
    // Rounding to 8 bits is noise of a twelfth of a step squared.
    EXPECT_NEAR(height_noise(coded_heights(heights_of(300, 300, smooth), 8).codes),
                std::sqrt(1.0 / 12.0) / 255.0, 0.15 * std::sqrt(1.0 / 12.0) / 255.0);
}

TEST(HeightDepth, HugeFloatsAreNoCodes) {
    Image huge = make_image(4, 1, 1, 32, ColorSpace::data);
    huge.samples = std::vector<float>{1e38F, -1e38F, 1e38F, -1e38F};
    EXPECT_EQ(height_depth(huge).bits, 0);
    EXPECT_EQ(height_depth(huge).step, 0.0);
}

}  // namespace
}  // namespace relief
