// SPDX-License-Identifier: Apache-2.0
// The choice of a kernel for a height map, and the power spectrum that it is estimated from.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "bump/height_tile.h"
#include "portable_math.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "support/images.h"
#include "support/labels.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::accuracy;
using namespace relief::detail;

namespace {

using Complex = std::complex<double>;
using testing::HasSubstr;

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

TEST(PowerSpectrum, TransformMatchesItsDefinitionAndInverts) {
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

TEST(PowerSpectrum, FilterRemovesNoiseAndKeepsWaves) {
    const HeightTile noise[] = {noise_of(0.5, 1), noise_of(0.5, 2), noise_of(0.5, 3)};
    const PowerSpectrum of_noise(noise);
    const auto without_noise = [](HeightTile tile, const PowerSpectrum& spectrum) {
        const std::vector<double> gains = spectrum.gains(NoiseSpectrum::white(0.5));
        remove_noise(std::span(&tile, 1), spectrum.gains_of_extension(gains));
        return tile;
    };
    EXPECT_LT(root_mean_square(without_noise(noise[0], of_noise), 8), 0.08);

    // Noise on a wave of 16 texels: the filtered result is far closer to the wave.
    const auto wave = [](int x, int y) { return std::sin(0.36 * x + 0.15 * y); };
    const HeightTile clean = tile_of(64, wave);
    HeightTile noisy[3] = {noise[0], noise[1], noise[2]};
    for (HeightTile& tile : noisy) {
        for (std::size_t i = 0; i < tile.values.size(); ++i)
            tile.values[i] += clean.values[i];
    }
    const PowerSpectrum of_noisy(noisy);
    HeightTile rest = without_noise(noisy[1], of_noisy);
    // Two tiles share a transform, which does not mix them.
    HeightTile pair[] = {noisy[0], noisy[1]};
    remove_noise(pair, of_noisy.gains_of_extension(of_noisy.gains(NoiseSpectrum::white(0.5))));
    for (std::size_t i = 0; i < rest.values.size(); ++i)
        EXPECT_NEAR(pair[1].values[i], rest.values[i], 1e-12);
    for (std::size_t i = 0; i < rest.values.size(); ++i)
        rest.values[i] -= clean.values[i];
    EXPECT_LT(root_mean_square(rest, 8), 0.3);
    EXPECT_GT(root_mean_square(rest, 8), 0.02);
}

TEST(PowerSpectrum, FilterIsTheFractionOfSignalPower) {
    const HeightTile noise[] = {noise_of(1.0, 5), noise_of(1.0, 6)};
    const PowerSpectrum spectrum(noise);
    // With a power of 1 everywhere, noise of 0.3 of the deviation gives a gain of 0.91.
    const std::vector<double> gains = spectrum.gains(NoiseSpectrum::white(0.3));
    double sum = 0.0;
    for (int i = 0; i < 60; ++i)
        sum += std::pow(gains[spectrum.bin_at(0.3 + 0.04 * i, 1.0)], 2);
    EXPECT_NEAR(sum / 60.0, 0.91, 0.05);
    EXPECT_EQ(spectrum.gains(NoiseSpectrum::white(2.0))[spectrum.bin_at(1.0, 1.0)], 0.0);
    EXPECT_NEAR(spectrum.excess_over(NoiseSpectrum::white(0.5)), 3.0, 0.2);
    EXPECT_LT(spectrum.excess_over(NoiseSpectrum::white(1.0)), 0.01);
    EXPECT_NEAR(spectrum.white_floor(), 1.0, 0.1);
    // A pattern on every other texel is not a white noise floor, however strong it is.
    const HeightTile pattern[] = {tile_of(64, [](int x, int y) { return (x + y) % 2 * 50.0; })};
    EXPECT_LT(PowerSpectrum(pattern).white_floor(), 1e-9);
}

TEST(PowerSpectrum, GrainDecaysMoreSlowlyThanASurface) {
    const auto wave = [](int x, int y) { return 20.0 * std::sin(0.1 * x + 0.05 * y); };
    Random random(9);
    const auto noisy = [&](int x, int y) { return wave(x, y) + random.normal(); };
    const HeightTile white[] = {tile_of(64, noisy), tile_of(64, noisy)};
    const auto grain = PowerSpectrum(white).grain();
    ASSERT_TRUE(grain);
    EXPECT_NEAR(grain->deviation(), 1.0, 0.1);
    const HeightTile clean[] = {tile_of(64, wave)};
    EXPECT_FALSE(PowerSpectrum(clean).grain());
    // Noise with less power at low frequencies, as after sharpening.
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

/// The chosen kernel is at most a fifth worse than the best single kernel.
constexpr double promised = 1.2;
/// After de-staircasing, the remaining steps are less regular than in the error model.
constexpr double promised_destaircased = 1.3;

double error_by(const BumpField& field, Kernel kernel, int radius) {
    BumpOptions options = field.options;
    options.kernel = kernel;
    options.gaussian_radius = radius;
    options.arithmetic = Arithmetic::float64;
    Report report;
    return normal_error(normals_from_height(field.heights, options, report), field).rms;
}

double min_error(const BumpField& field) {
    double least = std::numeric_limits<double>::infinity();
    for (const Kernel kernel :
         {Kernel::forward, Kernel::central3, Kernel::prewitt3, Kernel::sobel3, Kernel::scharr3,
          Kernel::sobel5, Kernel::scharr5, Kernel::central5, Kernel::central7})
        least = std::min(least, error_by(field, kernel, 2));
    double min_gaussian = std::numeric_limits<double>::infinity();
    for (int radius = 1; radius <= max_kernel_radius; radius += radius < 12 ? 1 : 2) {
        const double error = error_by(field, Kernel::gaussian, radius);
        min_gaussian = std::min(min_gaussian, error);
        if (radius > 3 && error > 1.5 * min_gaussian) break;
    }
    return std::min(least, min_gaussian);
}

void expect_promise_kept(const FieldRecipe& recipe, int width, int height, bool destaircased) {
    BumpField field = make_bump_field(recipe, width, height);
    const KernelChoice choice = choose_kernel(field.heights, field.options, destaircased);
    if (destaircased) field.heights = destaircase(field.heights, {*field.options.wrap}).heights;
    const double least = min_error(field);
    EXPECT_LE(error_by(field, choice.kernel, choice.gaussian_radius),
              (destaircased ? promised_destaircased : promised) * least)
        << recipe.name << ", " << width << " x " << height << ": " << choice.reason;
}

class KernelChoiceOnFields : public testing::TestWithParam<FieldRecipe> {};

TEST_LABELS(slow, sweep);
TEST_P(KernelChoiceOnFields, IsWithinAFifthOfTheBestKernel) {
    expect_promise_kept(GetParam(), 128, 128, false);
    expect_promise_kept(GetParam(), 256, 256, false);
    expect_promise_kept(GetParam(), 200, 200, false);
}

TEST_LABELS(slow, sweep);
TEST_P(KernelChoiceOnFields, AlsoAfterDestaircasing) {
    expect_promise_kept(GetParam(), 128, 128, true);
    expect_promise_kept(GetParam(), 200, 200, true);
}

std::string test_name(const testing::TestParamInfo<FieldRecipe>& row) {
    std::string name;
    for (const char* letter = row.param.name; *letter != 0; ++letter)
        name += std::isalnum(static_cast<unsigned char>(*letter)) != 0 ? *letter : '_';
    return name;
}

INSTANTIATE_TEST_SUITE_P(Tuned, KernelChoiceOnFields, testing::ValuesIn(tuning_fields()),
                         test_name);
INSTANTIATE_TEST_SUITE_P(Judged, KernelChoiceOnFields, testing::ValuesIn(evaluation_fields()),
                         test_name);

KernelChoice choice_on(const FieldRecipe& recipe) {
    const BumpField field = make_bump_field(recipe, 256, 256);
    return choose_kernel(field.heights, field.options);
}

TEST(KernelChoice, StatesItsReason) {
    using enum FieldShape;
    using enum FieldCoding;
    const KernelChoice smooth = choice_on({"", waves, 32, 0.3, float32, 0, 1});
    EXPECT_EQ(smooth.kernel, Kernel::central7);
    EXPECT_THAT(smooth.reason, HasSubstr("float heights: detail outweighs rounding"));
    const KernelChoice stairs = choice_on({"", waves, 32, 0.3, bits8, 0, 1});
    EXPECT_EQ(stairs.kernel, Kernel::gaussian);
    EXPECT_EQ(stairs.depth.bits, 8);
    EXPECT_THAT(stairs.reason, HasSubstr("8 bits used: steps of 0."));
    EXPECT_THAT(stairs.reason, HasSubstr("so heights are smoothed over"));
    const KernelChoice noisy = choice_on({"", waves, 32, 0.3, float32, 0.1, 1});
    EXPECT_EQ(noisy.kernel, Kernel::gaussian);
    EXPECT_NEAR(noisy.noise, 0.1, 0.005);
    EXPECT_THAT(noisy.reason, HasSubstr("texels outweighs fine detail"));
    const KernelChoice walls = choice_on({"", terraces, 24, 1.0, float32, 0, 1});
    EXPECT_EQ(walls.kernel, Kernel::central3);
    EXPECT_GT(walls.walls, 0.01);
    EXPECT_THAT(walls.reason, HasSubstr("next to sharp walls"));
}

TEST(KernelChoice, StatesTheFractionOfOutliers) {
    const FieldRecipe recipe{"", FieldShape::waves, 32.0, 0.3, FieldCoding::bits16, 0.0, 1};
    BumpField field = make_bump_field(recipe, 256, 256);
    const std::span<std::uint16_t> codes = field.heights.as<std::uint16_t>();
    for (std::size_t y = 8; y < 256; y += 16) {
        for (std::size_t x = 8; x < 256; x += 16) {
            std::uint16_t& code = codes[y * 256 + x];
            code = static_cast<std::uint16_t>(code < 32768 ? code + 20000 : code - 20000);
        }
    }
    const KernelChoice choice = choose_kernel(field.heights, field.options);
    EXPECT_EQ(choice.spikes, 1.0 / 256.0);
    EXPECT_THAT(choice.reason, HasSubstr("isolated outliers (0.39% of the texels)"));
}

TEST_LABELS(not_sanitized);
TEST(KernelChoice, ExpectsTheErrorThatThereIs) {
    // If rounding and noise are white, the prediction is accurate within one half.
    for (const char* name : {"smooth, 16 bit", "detailed, 8 bit", "steep, 8 bit",
                             "noise 0.03, detailed, 16 bit", "mixed, 8 bit"}) {
        for (const FieldRecipe& recipe : tuning_fields()) {
            if (std::string(recipe.name) != name) continue;
            const BumpField field = make_bump_field(recipe, 256, 256);
            const KernelChoice choice = choose_kernel(field.heights, field.options);
            const double error = error_by(field, choice.kernel, choice.gaussian_radius);
            EXPECT_NEAR(choice.rms_degrees / error, 1.0, 0.5) << name;
            EXPECT_EQ(choice.predictions.front().rms_degrees <= choice.rms_degrees, true);
        }
    }
}

TEST_LABELS(not_sanitized);
TEST(KernelChoice, ExpectsTheErrorOfNoiseOnMapsOfAnyWidth) {
    const FieldRecipe recipe{"", FieldShape::waves, 32.0, 0.3, FieldCoding::bits8, 1.0, 5};
    for (const int width : {128, 144, 160, 191, 192, 200, 256, 257}) {
        const BumpField field = make_bump_field(recipe, width, 128);
        const KernelChoice choice = choose_kernel(field.heights, field.options);
        const double error = error_by(field, choice.kernel, choice.gaussian_radius);
        EXPECT_NEAR(choice.rms_degrees / error, 1.0, 0.4) << width << ": " << choice.reason;
    }
}

TEST(KernelChoice, HandlesConstantAndTinyMaps) {
    const Image flat = test::heights_of(64, 64, [](int, int) { return 0.25; });
    const KernelChoice choice = choose_kernel(flat, {});
    EXPECT_EQ(choice.kernel, Kernel::central3);
    EXPECT_EQ(choice.rms_degrees, 0.0);
    EXPECT_THAT(choice.reason, HasSubstr("every kernel is exact"));
    // The eight other kernels and three radii: for exact heights, the search stops at small radii.
    EXPECT_EQ(choice.predictions.size(), 11U);
    for (const auto& [width, height] : {std::pair(1, 1), {1, 40}, {40, 1}, {7, 3}, {9, 11}}) {
        const KernelChoice tiny = choose_kernel(test::rough(width, height), {});
        // Too few texels give no error estimate, unless all kernels are exact.
        const bool is_known = width * height == 1 || width * height >= 64;
        EXPECT_EQ(std::isfinite(tiny.rms_degrees), is_known) << width << " x " << height;
        EXPECT_FALSE(tiny.reason.empty());
    }
    Image holes = test::rough(64, 64);
    for (float& height : holes.as<float>())
        height = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(choose_kernel(holes, {}).kernel, Kernel::central3);
}

TEST(KernelChoice, IsTheSameForAnyNumberOfThreadsAndFromPartsReadInTurn) {
    const BumpField field = make_bump_field(tuning_fields()[3], 512, 400);
    const KernelChoice all = choose_kernel(field.heights, field.options);
    set_thread_limit(1);
    std::vector<Image> parts;
    for (const ImagePart& place : parts_to_analyze(512, 400))
        parts.push_back(part_of(field.heights, place));
    const KernelChoice one = choose_kernel(parts, field.options);
    set_thread_limit(0);
    EXPECT_EQ(one.rms_degrees, all.rms_degrees);
    EXPECT_EQ(one.reason, all.reason);
}

TEST(KernelChoice, SamplesPartsFromTopToBottom) {
    EXPECT_EQ(parts_to_analyze(128, 128).size(), 1U);
    EXPECT_EQ(parts_to_analyze(191, 128).size(), 1U);
    EXPECT_EQ(parts_to_analyze(192, 128).size(), 2U);
    EXPECT_EQ(parts_to_analyze(100000, 5).size(), 1U);
    for (const auto& [width, height] :
         {std::pair(32768, 32768), {100, 75}, {4096, 16}, {130, 5000}, {8, 8}, {384, 384}}) {
        const std::vector<ImagePart> parts = parts_to_analyze(width, height);
        EXPECT_LE(parts.size(), 9U);
        int row = 0;
        for (const ImagePart& part : parts) {
            EXPECT_GE(part.y, row);
            row = part.y;
            EXPECT_LE(part.x + part.width, width);
            EXPECT_LE(part.y + part.height, height);
            EXPECT_LE(part.width, 128);
        }
        // The tiles reach into the last third of both sides.
        EXPECT_GT(parts.back().x + parts.back().width, 2 * width / 3);
        EXPECT_GT(parts.back().y + parts.back().height, 2 * height / 3);
    }
}

TEST(KernelChoice, RefusesInvalidParts) {
    EXPECT_THROW(choose_kernel(std::span<const Image>{}, {}), InvalidInput);
    EXPECT_THROW(choose_kernel(Image{}, {}), InvalidInput);
    EXPECT_THROW(choose_kernel(make_image(9, 9, 3, 8, ColorSpace::data), {}), InvalidInput);
    const Image mixed[] = {make_image(9, 9, 1, 8, ColorSpace::data),
                           make_image(9, 9, 1, 16, ColorSpace::data)};
    EXPECT_THROW(choose_kernel(mixed, {}), InvalidInput);
    EXPECT_THROW(parts_to_analyze(0, 5), InvalidInput);
}

TEST(KernelChoiceOnRealMaps, A16BitMapIsNotSmoothedAndAnHalfFloatOneHardly) {
    RELIEF_NEEDS_SHARED(hex, "data/textures/height_only/hexMap_height_1024_u16.png");
    const Image height = height_field(read_image(hex, ImageUse::data));
    const KernelChoice choice = choose_kernel(height, {});
    EXPECT_EQ(choice.depth.bits, 16);
    EXPECT_NE(choice.kernel, Kernel::gaussian) << choice.reason;
}

}  // namespace
}  // namespace relief
