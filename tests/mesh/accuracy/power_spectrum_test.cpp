// SPDX-License-Identifier: Apache-2.0
// The Fourier transform against its definition, the spectra of noise and of waves.
#include "bump/power_spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "random.h"

namespace relief {
namespace {

using Complex = std::complex<double>;

HeightTile tile_of(int side, const std::function<double(int, int)>& at) {
    HeightTile tile{side, side, Wrap::clamp, {}};
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x)
            tile.values.push_back(at(x, y));
    }
    return tile;
}

HeightTile noise_of(double deviation, std::uint32_t seed) {
    Random random(seed);
    return tile_of(64, [&](int, int) { return deviation * random.normal(); });
}

double root_mean_square(const HeightTile& tile, int margin) {
    double squares = 0.0;
    int count = 0;
    for (int y = margin; y < tile.height - margin; ++y) {
        for (int x = margin; x < tile.width - margin; ++x) {
            squares += std::pow(tile.values[static_cast<std::size_t>(y * tile.width + x)], 2);
            ++count;
        }
    }
    return std::sqrt(squares / count);
}

TEST(PowerSpectrum, TheTransformIsThatOfItsDefinitionAndGoesBack) {
    constexpr int side = 8;
    Random random(3);
    std::vector<Complex> square(side * side);
    for (Complex& value : square)
        value = {random.normal(), random.normal()};
    std::vector<Complex> transformed = square;
    transform_square(transformed, side, false);
    for (int v = 0; v < side; ++v) {
        for (int u = 0; u < side; ++u) {
            Complex sum = 0.0;
            for (int y = 0; y < side; ++y) {
                for (int x = 0; x < side; ++x)
                    sum += square[static_cast<std::size_t>(y * side + x)] *
                           std::polar(1.0, -2.0 * std::numbers::pi * (u * x + v * y) / side);
            }
            EXPECT_LT(std::abs(transformed[static_cast<std::size_t>(v * side + u)] - sum), 1e-12);
        }
    }
    transform_square(transformed, side, true);
    for (std::size_t i = 0; i < square.size(); ++i)
        EXPECT_LT(std::abs(transformed[i] / 64.0 - square[i]), 1e-13);
}

TEST(PowerSpectrum, NothingIsLeftOfNoiseAndNearlyAllOfWaves) {
    const HeightTile noise[] = {noise_of(0.5, 1), noise_of(0.5, 2), noise_of(0.5, 3)};
    const PowerSpectrum of_noise(noise);
    EXPECT_LT(root_mean_square(without_noise(noise[0], of_noise, NoiseSpectrum::white(0.5)), 8),
              0.08);

    // Noise on a wave of 16 texels: what is left is far closer to the wave.
    const auto wave = [](int x, int y) { return std::sin(0.36 * x + 0.15 * y); };
    const HeightTile clean = tile_of(64, wave);
    HeightTile noisy[3] = {noise[0], noise[1], noise[2]};
    for (HeightTile& tile : noisy) {
        for (std::size_t i = 0; i < tile.values.size(); ++i)
            tile.values[i] += clean.values[i];
    }
    HeightTile rest = without_noise(noisy[1], PowerSpectrum(noisy), NoiseSpectrum::white(0.5));
    for (std::size_t i = 0; i < rest.values.size(); ++i)
        rest.values[i] -= clean.values[i];
    EXPECT_LT(root_mean_square(rest, 8), 0.3);
    EXPECT_GT(root_mean_square(rest, 8), 0.02);
}

TEST(PowerSpectrum, TheFilterIsTheShareOfPowerThatIsNotNoise) {
    const HeightTile noise[] = {noise_of(1.0, 5), noise_of(1.0, 6)};
    const PowerSpectrum spectrum(noise);
    // Of power 1 all round, noise of 0.3 of the deviation leaves 0.91.
    const std::vector<double> gains = spectrum.gains(NoiseSpectrum::white(0.3));
    double sum = 0.0;
    for (int i = 0; i < 60; ++i)
        sum += std::pow(gains[spectrum.bin_at(0.3 + 0.04 * i, 1.0)], 2);
    EXPECT_NEAR(sum / 60.0, 0.91, 0.05);
    EXPECT_EQ(spectrum.gains(NoiseSpectrum::white(2.0))[spectrum.bin_at(1.0, 1.0)], 0.0);
    EXPECT_NEAR(spectrum.excess_over(NoiseSpectrum::white(0.5)), 3.0, 0.2);
    EXPECT_LT(spectrum.excess_over(NoiseSpectrum::white(1.0)), 0.01);
    EXPECT_NEAR(spectrum.white_floor(), 1.0, 0.1);
    // A pattern on every other texel, however strong, is no white floor.
    const HeightTile pattern[] = {tile_of(64, [](int x, int y) { return (x + y) % 2 * 50.0; })};
    EXPECT_LT(PowerSpectrum(pattern).white_floor(), 1e-9);
}

TEST(PowerSpectrum, GrainIsWhatFallsMoreSlowlyThanASurface) {
    const auto wave = [](int x, int y) { return 20.0 * std::sin(0.1 * x + 0.05 * y); };
    Random random(9);
    const auto noisy = [&](int x, int y) { return wave(x, y) + random.normal(); };
    const HeightTile white[] = {tile_of(64, noisy), tile_of(64, noisy)};
    const auto grain = PowerSpectrum(white).grain();
    ASSERT_TRUE(grain);
    EXPECT_NEAR(grain->deviation(), 1.0, 0.1);
    const HeightTile clean[] = {tile_of(64, wave)};
    EXPECT_FALSE(PowerSpectrum(clean).grain());
    // Noise with less power at low frequencies, as sharpening leaves it.
    NoiseSpectrum blue;
    blue.side = 64;
    blue.rings.clear();
    for (int ring = 0; ring < 64; ++ring)
        blue.rings.push_back(0.001 * ring * ring);
    HeightTile colored[] = {tile_of(64, wave), tile_of(64, wave)};
    for (std::uint32_t i = 0; i < 2; ++i) {
        const std::vector<double> noise = noise_field(blue, 64, i + 1);
        for (std::size_t texel = 0; texel < noise.size(); ++texel)
            colored[i].values[texel] += noise[texel];
    }
    const auto found = PowerSpectrum(colored).grain();
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->deviation() / blue.deviation(), 1.0, 0.1);
    EXPECT_LT(found->at(0.8, 0.0), 0.3 * found->at(2.5, 0.0));
}

}  // namespace
}  // namespace relief
