// SPDX-License-Identifier: Apache-2.0
// Estimates of noise that is not white: blurred noise, offsets of rows, noise that grows with the
// height, blocks of JPEG, and few levels.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "bump/height_tile.h"
#include "portable_math.h"
#include "relief/mesh/height_map.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr int tile_side = 128;

template <typename At>
HeightTile tile_with(const At& at) {
    HeightTile tile{tile_side, tile_side, Wrap::clamp, {}};
    for (int y = 0; y < tile_side; ++y) {
        for (int x = 0; x < tile_side; ++x)
            tile.values.push_back(at(x, y));
    }
    return tile;
}

double smooth_surface(int x, int y) {
    return 4.0 * std::sin(0.11 * x + 0.06 * y) + 3.0 * std::sin(0.07 * y - 0.12 * x + 1.0);
}

TEST(LineNoise, IsEstimatedAndRemoved) {
    Random random(4);
    std::array<double, tile_side> offsets{};
    for (double& offset : offsets)
        offset = 0.2 * random.normal();
    HeightTile tile = tile_with([&](int x, int y) {
        return smooth_surface(x, y) + offsets[static_cast<std::size_t>(y)] + 0.02 * random.normal();
    });
    const LineNoise noise = line_noise(std::span(&tile, 1), 0.0);
    EXPECT_NEAR(noise.rows, 0.2, 0.06);
    EXPECT_EQ(noise.columns, 0.0);
    remove_line_noise(tile, noise);
    const LineNoise rest = line_noise(std::span(&tile, 1), 0.0);
    EXPECT_LT(rest.rows, 0.05);
}

TEST(LineNoise, IsNotDetectedInCorrugationsAndWhiteNoise) {
    const HeightTile corrugated = tile_with([](int, int y) { return std::sin(0.4 * y); });
    EXPECT_EQ(line_noise(std::span(&corrugated, 1), 0.0).rows, 0.0);
    Random random(5);
    const HeightTile white =
        tile_with([&](int x, int y) { return smooth_surface(x, y) + random.normal(); });
    EXPECT_EQ(line_noise(std::span(&white, 1), 0.0).rows, 0.0);
    EXPECT_EQ(line_noise(std::span(&white, 1), 0.0).columns, 0.0);
}

TEST(NoiseByHeight, GrowsWithTheHeight) {
    Random random(6);
    const HeightTile tile = tile_with([&](int x, int y) {
        const double height = smooth_surface(x, y);
        return height + (0.1 + 0.02 * (height + 7.0)) * random.normal();
    });
    const auto noise = noise_by_height(std::span(&tile, 1));
    ASSERT_TRUE(noise);
    EXPECT_NEAR(noise->at(-4.0), 0.16, 0.03);
    EXPECT_NEAR(noise->at(4.0), 0.32, 0.05);
    const HeightTile constant =
        tile_with([&](int x, int y) { return smooth_surface(x, y) + 0.2 * random.normal(); });
    EXPECT_FALSE(noise_by_height(std::span(&constant, 1)));
}

TEST(NoiseByHeight, GrowsFromAGroundWithoutNoise) {
    Random random(8);
    const HeightTile tile = tile_with([&](int x, int y) {
        const double height = std::max(0.0, smooth_surface(x, y));
        return height + 0.05 * height * random.normal();
    });
    const auto noise = noise_by_height(std::span(&tile, 1));
    ASSERT_TRUE(noise);
    EXPECT_NEAR(noise->at(4.0), 0.2, 0.05);
    EXPECT_LT(noise->at(0.0), 0.01);
}

TEST(NoiseByHeight, GrowsAboveAFlatGroundThatIsMostOfTheMap) {
    Random random(9);
    const auto ground = [](int x, int y) { return std::max(0.0, smooth_surface(x, y) - 0.5); };
    const HeightTile tile = tile_with([&](int x, int y) {
        const double height = ground(x, y);
        return height + 0.05 * height * random.normal();
    });
    const auto noise = noise_by_height(std::span(&tile, 1));
    ASSERT_TRUE(noise);
    EXPECT_NEAR(noise->at(4.0), 0.2, 0.05);
    EXPECT_LT(noise->at(0.0), 0.01);
    EXPECT_FALSE(noise_by_height(std::vector{tile_with(ground)}));
}

TEST(BlockQuantization, StepsAreEstimatedFromDecodedHeights) {
    BlockQuantization steps;
    for (std::size_t i = 0; i < steps.steps.size(); ++i)
        steps.steps[i] = static_cast<double>(6 + i / 8 + i % 8);
    Random random(7);
    const HeightTile detailed = tile_with([&](int x, int y) {
        return std::round(120.0 + 10.0 * smooth_surface(x, y) + 8.0 * random.normal());
    });
    EXPECT_FALSE(block_quantization(std::span(&detailed, 1), 1.0));
    // The blocks of quantize_blocks() begin at texel 4.
    HeightTile quantized = detailed;
    quantize_blocks(quantized, steps, 1.0);
    constexpr int side = 112;
    HeightTile inside{side, side, Wrap::clamp, {}};
    for (int y = 4; y < 4 + side; ++y) {
        for (int x = 4; x < 4 + side; ++x) {
            inside.values.push_back(
                std::round(quantized.values[static_cast<std::size_t>(y * tile_side + x)]));
        }
    }
    const auto found = block_quantization(std::span(&inside, 1), 1.0);
    ASSERT_TRUE(found);
    for (const std::size_t i : {0U, 1U, 2U, 8U, 9U, 16U})
        EXPECT_EQ(found->steps[i], steps.steps[i]) << i;
    // The smoothed heights have the same quantized coefficients.
    HeightTile smooth = inside;
    remove_blocks(smooth, *found);
    EXPECT_NE(smooth.values, inside.values);
}

template <typename Power>
NoiseSpectrum spectrum_of(const Power& power) {
    NoiseSpectrum spectrum;
    spectrum.side = tile_side;
    spectrum.rings.clear();
    for (int ring = 0; ring < tile_side; ++ring)
        spectrum.rings.push_back(power(6.2831853 * std::max(1, ring) / tile_side));
    return spectrum;
}

/// A surface with a field of this spectrum.
HeightTile rough_tile(const NoiseSpectrum& spectrum, std::uint32_t seed) {
    const std::vector<double> values = noise_field(spectrum, tile_side, seed);
    return tile_with([&](int x, int y) {
        return smooth_surface(x, y) + values[static_cast<std::size_t>(y * tile_side + x)];
    });
}

TEST(PowerSpectrum, BlurredNoiseIsDetectedAndASurfaceIsNot) {
    constexpr double blur = 1.2;
    const NoiseSpectrum noise =
        spectrum_of([](double f) { return 0.01 * std::exp(-blur * blur * f * f); });
    const NoiseSpectrum surface =
        spectrum_of([](double f) { return 0.01 * std::pow(f, -3.0) * std::exp(-0.5 * f * f); });
    const HeightTile noisy[] = {rough_tile(noise, 1), rough_tile(noise, 2)};
    const auto found = PowerSpectrum(noisy).blurred_noise(1e-6);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->deviation() / noise.deviation(), 1.0, 0.15);
    const HeightTile rough[] = {rough_tile(surface, 1), rough_tile(surface, 2)};
    EXPECT_FALSE(PowerSpectrum(rough).blurred_noise(1e-6));
}

TEST(PowerSpectrum, PeriodicDetailIsKeptWhereOnlyNoiseIsExpected) {
    NoiseSpectrum noise = NoiseSpectrum::white(0.1);
    noise.min_noise_only_frequency = 0.3;
    Random random(3);
    const HeightTile tiles[] = {tile_with([&](int x, int) {
        return std::sin(6.2831853 * 16.0 / tile_side * x) + 0.1 * random.normal();
    })};
    const PowerSpectrum spectrum(tiles);
    const std::vector<double> gains = spectrum.gains(noise);
    EXPECT_GT(gains[spectrum.bin_at(6.2831853 * 16.0 / tile_side, 0.0)], 0.9);
    EXPECT_EQ(gains[spectrum.bin_at(1.5, 1.0)], 0.0);
}

TEST(WidelyBlurredNoise, IsDetectedAndASurfaceIsNot) {
    constexpr double blur = 3.0;
    const NoiseSpectrum noise =
        spectrum_of([](double f) { return 0.3 * std::exp(-blur * blur * f * f); });
    const HeightTile noisy[] = {rough_tile(noise, 1), rough_tile(noise, 2), rough_tile(noise, 3)};
    const auto found = widely_blurred_noise(noisy, 1e-6);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->deviation() / noise.deviation(), 1.0, 0.2);
    const NoiseSpectrum surface = spectrum_of([](double f) { return 0.01 * std::pow(f, -3.0); });
    const HeightTile rough[] = {rough_tile(surface, 1), rough_tile(surface, 2),
                                rough_tile(surface, 3)};
    EXPECT_FALSE(widely_blurred_noise(rough, 1e-6));
    const HeightTile smooth[] = {tile_with(smooth_surface)};
    EXPECT_FALSE(widely_blurred_noise(smooth, 1e-6));
}

TEST(SlopeVariance, IsTheSquaredNoiseGainForNoiseThatTheKernelResolves) {
    // The kernel has hardly any response near the Nyquist frequency, where the sum is inaccurate.
    const GradientKernel kernel = gradient_kernel(Kernel::gaussian, 4);
    const double gain = noise_gain(kernel);
    EXPECT_NEAR(slope_variance(kernel, NoiseSpectrum::white(0.5)) / (0.25 * gain * gain), 1.0,
                0.02);
}

TEST(HeightDepth, LevelsThatWereRoundedToCodes) {
    const auto depth_of = [](const auto& code_of) {
        Image image = make_image(64, 64, 1, 8, ColorSpace::data);
        for (std::size_t i = 0; i < 64 * 64; ++i)
            image.as<std::uint8_t>()[i] = static_cast<std::uint8_t>(code_of(i));
        return height_depth(image);
    };
    const HeightDepth rounded = depth_of([](std::size_t i) { return (i % 32 * 255 + 15) / 31; });
    EXPECT_EQ(rounded.bits, 5);
    EXPECT_NEAR(rounded.step, 1.0 / 31.0, 5e-3 / 31.0);
    // The high bits are copied into the low ones.
    const HeightDepth copied = depth_of([](std::size_t i) { return i % 64 << 2 | i % 64 >> 4; });
    EXPECT_EQ(copied.bits, 6);
    EXPECT_NEAR(copied.step, 1.0 / 63.0, 5e-3 / 63.0);
    // Few adjacent codes, and few codes of a mask, are no levels.
    EXPECT_EQ(depth_of([](std::size_t i) { return 100 + i % 25; }).bits, 8);
    EXPECT_EQ(depth_of([](std::size_t i) { return std::array{0, 63, 130, 255}[i % 4]; }).bits, 8);
}

}  // namespace
}  // namespace relief
