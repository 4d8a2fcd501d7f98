// SPDX-License-Identifier: Apache-2.0
// Height maps: heights from image channels, statistics, and the removal of quantization steps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "image/height_holes.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "support/images.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::accuracy;
using namespace relief::detail;

namespace {

using test::heights_of;
using test::message_of;
using test::samples_of;
using testing::Each;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::FloatNear;

Image rgba16(std::vector<std::uint16_t> samples) {
    Image image = make_image(static_cast<int>(samples.size() / 4), 1, 4, 16, ColorSpace::data);
    image.samples = std::move(samples);
    return image;
}

TEST(HeightField, GrayIsItselfRgbItsMeanAndAlphaIsLeftOut) {
    Image gray = make_image(2, 1, 2, 8, ColorSpace::data);
    gray.samples = std::vector<std::uint8_t>{51, 7, 255, 0};
    EXPECT_THAT(samples_of<float>(height_field(gray)), ElementsAre(0.2F, 1.0F));
    Image rgb = make_image(1, 1, 4, 16, ColorSpace::data);
    rgb.samples = std::vector<std::uint16_t>{65535, 0, 13107, 9};
    EXPECT_THAT(samples_of<float>(height_field(rgb)), ElementsAre(0.4F));
    Image floats = make_image(1, 1, 3, 32, ColorSpace::data);
    floats.samples = std::vector<float>{-3.0F, 0.0F, 9.0F};
    EXPECT_THAT(samples_of<float>(height_field(floats)), ElementsAre(2.0F));
}

TEST(HeightField, AGrayPictureStoredAsRgbGivesTheHeightsOfTheGrayOne) {
    Image gray = make_image(256, 1, 1, 8, ColorSpace::data);
    Image rgb = make_image(256, 1, 3, 8, ColorSpace::srgb);
    for (std::size_t code = 0; code < 256; ++code) {
        gray.as<std::uint8_t>()[code] = static_cast<std::uint8_t>(code);
        for (std::size_t channel = 0; channel < 3; ++channel)
            rgb.as<std::uint8_t>()[code * 3 + channel] = static_cast<std::uint8_t>(code);
    }
    EXPECT_EQ(height_field(rgb).samples, height_field(gray).samples);
}

TEST(HeightField, AnEmptyImageIsRefused) {
    EXPECT_THROW(height_field(Image{}), InvalidInput);
}

TEST(HeightField, UsesTheRequestedChannel) {
    const Image image = rgba16({65535, 0, 13107, 26214});
    EXPECT_THAT(samples_of<float>(height_field(image, HeightChannel::red)), ElementsAre(1.0F));
    EXPECT_THAT(samples_of<float>(height_field(image, HeightChannel::green)), ElementsAre(0.0F));
    EXPECT_THAT(samples_of<float>(height_field(image, HeightChannel::blue)), ElementsAre(0.2F));
    EXPECT_THAT(samples_of<float>(height_field(image, HeightChannel::alpha)), ElementsAre(0.4F));
}

TEST(HeightField, LuminanceIsOfDecodedColors) {
    Image image = make_image(4, 1, 3, 8, ColorSpace::data);
    // Pure colors give the weights of Rec. 709. Gray of code 188 is half as bright as white.
    image.samples = std::vector<std::uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 255, 188, 188, 188};
    EXPECT_THAT(samples_of<float>(height_field(image, HeightChannel::luminance)),
                ElementsAre(0.2126F, 0.7152F, 0.0722F, FloatNear(0.5029F, 1e-4F)));
    Image floats = make_image(1, 1, 3, 32, ColorSpace::data);
    floats.samples = std::vector<float>{2.0F, 2.0F, 2.0F};
    EXPECT_THAT(samples_of<float>(height_field(floats, HeightChannel::luminance)),
                ElementsAre(2.0F))
        << "float samples are linear already";
}

TEST(HeightField, GrayImagesHaveOneChannelOfHeights) {
    Image gray = make_image(1, 1, 2, 8, ColorSpace::data);
    gray.samples = std::vector<std::uint8_t>{51, 102};
    for (const HeightChannel channel :
         {HeightChannel::mean, HeightChannel::luminance, HeightChannel::red})
        EXPECT_THAT(samples_of<float>(height_field(gray, channel)), ElementsAre(0.2F));
    EXPECT_THAT(samples_of<float>(height_field(gray, HeightChannel::alpha)), ElementsAre(0.4F));
    EXPECT_EQ(message_of<InvalidInput>([&] { height_field(gray, HeightChannel::blue); }),
              "a gray image has no blue channel to take heights from");
    const Image rgb = make_image(1, 1, 3, 8, ColorSpace::data);
    EXPECT_EQ(message_of<InvalidInput>([&] { height_field(rgb, HeightChannel::alpha); }),
              "the image has no alpha channel to take heights from");
}

TEST(HeightMap, KeepsTheSamplesOfAGrayImage) {
    Image gray = make_image(2, 1, 1, 16, ColorSpace::data);
    gray.samples = std::vector<std::uint16_t>{1, 65535};
    const HeightMap map = height_map(std::move(gray));
    EXPECT_THAT(samples_of<std::uint16_t>(map.heights), ElementsAre(1, 65535));
    EXPECT_TRUE(map.alpha.empty());
    EXPECT_TRUE(map.transparent.empty());
}

TEST(HeightMap, ReportsTransparentTexels) {
    const HeightMap map = height_map(rgba16({0, 0, 0, 0, 9, 9, 9, 1, 9, 9, 9, 65535}));
    EXPECT_THAT(samples_of<std::uint16_t>(map.alpha), ElementsAre(0, 1, 65535));
    EXPECT_THAT(map.transparent, ElementsAre(1, 0, 0));
    EXPECT_EQ(map.transparent_count(), 1U);
    EXPECT_TRUE(height_map(rgba16({0, 0, 0, 1})).transparent.empty());
    EXPECT_TRUE(height_map(rgba16({0, 0, 0, 0}), HeightChannel::alpha).transparent.empty())
        << "alpha that is the height hides nothing";
}

TEST(FilledHoles, OneFiniteHeightInACornerFillsTheWholeMap) {
    for (const std::size_t corner : {0, 2, 3, 5}) {
        Image heights = make_image(3, 2, 1, 32, ColorSpace::data);
        for (float& height : heights.as<float>())
            height = std::numeric_limits<float>::quiet_NaN();
        heights.as<float>()[corner] = 0.5F;
        for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp}) {
            Report report;
            EXPECT_THAT(filled_holes(heights, wrap, report), Each(0.5F)) << corner;
            EXPECT_EQ(report.count("non-finite height"), 5U);
        }
    }
}

TEST(FilledHoles, TransparentTexelsAreFilledWithinTheKernelRadius) {
    // A plateau of 5 amid transparent garbage.
    Image heights = make_image(9, 9, 1, 32, ColorSpace::data);
    std::vector<std::uint8_t> transparent(81, 1);
    const auto at = [](int x, int y) { return static_cast<std::size_t>(9 * y + x); };
    for (std::size_t i = 0; i < 81; ++i)
        heights.as<float>()[i] = std::numeric_limits<float>::infinity();
    for (int y = 3; y < 6; ++y) {
        for (int x = 3; x < 6; ++x) {
            heights.as<float>()[at(x, y)] = 5.0F;
            transparent[at(x, y)] = 0;
        }
    }
    Report report;
    const std::vector<float> filled = filled_holes(heights, Wrap::clamp, report, {transparent, 2});
    EXPECT_TRUE(report.empty()) << "transparent texels are no fault";
    EXPECT_EQ(filled[at(1, 1)], 5.0F);
    EXPECT_EQ(filled[at(4, 7)], 5.0F);
    EXPECT_EQ(filled[at(0, 4)], 0.0F) << "no kernel of this radius finds it";
    // A hole on the surface is also filled, and counted.
    heights.as<float>()[at(4, 4)] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(filled_holes(heights, Wrap::clamp, report, {transparent, 2})[at(4, 4)], 5.0F);
    EXPECT_EQ(report.count("non-finite height"), 1U);
}

/// Returns the same codes in 16 bits, each times `factor` plus `offset`.
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
    // A ramp of 3 per column over 32 columns: the seam falls by 93, while neighbors differ by 3.
    const Tiling ramp = detect_tiling(heights_of(32, 8, [](int x, int) { return 3.0 * x; }));
    EXPECT_NEAR(ramp.seam_x, 31.0, 1e-6);
    EXPECT_EQ(ramp.seam_y, 0.0);
    EXPECT_EQ(ramp.wraps(), Wraps(Wrap::clamp, Wrap::repeat));
}

TEST(Tiling, APartOfATilingMapDoesNotTile) {
    const BumpField whole = wave_heights(128, 128, tiling_waves(128, 128, 12, 32.0, 0.3, 4));
    const Image part = heights_of(90, 128, [&](int x, int y) {
        return whole.heights.as<float>()[static_cast<std::size_t>(y * 128 + x)];
    });
    EXPECT_GT(detect_tiling(part).seam_x, 3.0);
    EXPECT_LT(detect_tiling(part).seam_y, 1.1);
}

TEST(Tiling, HandlesTinyMapsAndHoles) {
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

TEST(Tiling, IsRecognizedInRealMaps) {
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
    // The sum of 12 uniform numbers approximates a Gaussian of deviation 1.
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
        // 90,000 texels, 9 of which share a value, have a statistical error of 1 %.
        EXPECT_NEAR(height_noise(noisy), deviation, 0.03 * deviation);
    }
    // The rest of the waves: k^4 / 4 of them, through |.| and the factor.
    EXPECT_LT(height_noise(heights_of(300, 300, smooth)), 2e-5);
    EXPECT_EQ(height_noise(heights_of(2, 9, smooth)), 0.0);
    // Rounding to 8 bits is noise of a twelfth of a squared step.
    EXPECT_NEAR(height_noise(coded_heights(heights_of(300, 300, smooth), 8).codes),
                std::sqrt(1.0 / 12.0) / 255.0, 0.15 * std::sqrt(1.0 / 12.0) / 255.0);
}

TEST(HeightDepth, HugeFloatsAreNotCodes) {
    Image huge = make_image(4, 1, 1, 32, ColorSpace::data);
    huge.samples = std::vector<float>{1e38F, -1e38F, 1e38F, -1e38F};
    EXPECT_EQ(height_depth(huge).bits, 0);
    EXPECT_EQ(height_depth(huge).step, 0.0);
}

/// The heights as 8-bit codes, with 255 steps to 1.0.
Image in_8_bits(int width, int height, const std::function<double(int, int)>& steps) {
    Image codes = make_image(width, height, 1, 8, ColorSpace::data);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            codes.as<std::uint8_t>()[static_cast<std::size_t>(y * width + x)] =
                static_cast<std::uint8_t>(std::lround(steps(x, y)));
    }
    return codes;
}

ErrorStats error_by(const BumpField& field, Kernel kernel, int radius) {
    BumpOptions options = field.options;
    options.kernel = kernel;
    options.gaussian_radius = radius;
    Report report;
    return normal_error(normals_from_height(field.heights, options, report), field);
}

/// Returns the smallest error of any kernel.
double min_error(const BumpField& field) {
    double least = error_by(field, Kernel::central3, 2).rms;
    for (const Kernel kernel : {Kernel::scharr3, Kernel::sobel3, Kernel::prewitt3, Kernel::central5,
                                Kernel::central7, Kernel::sobel5, Kernel::scharr5})
        least = std::min(least, error_by(field, kernel, 2).rms);
    for (const int radius : {2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24})
        least = std::min(least, error_by(field, Kernel::gaussian, radius).rms);
    return least;
}

TEST(Destaircase, NeverMovesAHeightByMoreThanHalfAStep) {
    for (const FieldRecipe& recipe : tuning_fields()) {
        const BumpField field = make_bump_field(recipe, 96, 80);
        const Destaircased smooth = destaircase(field.heights, {*field.options.wrap});
        const Image stored = to_float(field.heights);
        double farthest = 0.0;
        for (std::size_t i = 0; i < stored.sample_count(); ++i) {
            farthest =
                std::max(farthest, std::abs(static_cast<double>(stored.as<float>()[i]) -
                                            static_cast<double>(smooth.heights.as<float>()[i])));
        }
        EXPECT_LE(farthest, 0.5 * smooth.step) << recipe.name;
        if (recipe.coding == FieldCoding::bits8 && recipe.noise == 0.0 && recipe.shortest >= 16.0) {
            EXPECT_EQ(smooth.step, 1.0 / 255.0) << recipe.name;
            EXPECT_GT(farthest, 0.3 * smooth.step) << recipe.name;
        }
    }
}

TEST(Destaircase, FloatsWithoutStepsAndConstantMapsStayToTheBit) {
    const Image floats = test::rough(31, 17);
    const Destaircased same = destaircase(floats);
    EXPECT_EQ(same.step, 0.0);
    EXPECT_EQ(same.heights.samples, floats.samples);
    const Image flat = in_8_bits(40, 30, [](int, int) { return 77.0; });
    EXPECT_THAT(samples_of<float>(destaircase(flat).heights), Each(77.0F / 255.0F));
    EXPECT_EQ(destaircase(in_8_bits(1, 1, [](int, int) { return 3.0; })).heights.sample_count(),
              1U);
}

TEST(Destaircase, APlaneIsRecoveredNearlyExactly) {
    // From 0.02 to 1.3 steps per texel, up to the border, where clamping continues the plane.
    for (const double slope : {0.02, 0.07, 0.31, 0.6180339, 1.3}) {
        const auto plane = [&](int x, int y) { return 8.0 + slope * (0.8 * x + 0.6 * y); };
        const Destaircased smooth =
            destaircase(in_8_bits(140, 90, plane), {Wrap::clamp, 1.0 / 255.0});
        double squares = 0.0;
        double stored = 0.0;
        for (int y = 0; y < 90; ++y) {
            for (int x = 0; x < 140; ++x) {
                const auto texel = static_cast<std::size_t>(y * 140 + x);
                const double found = 255.0 * static_cast<double>(smooth.heights.as<float>()[texel]);
                squares += std::pow(found - plane(x, y), 2);
                stored += std::pow(std::round(plane(x, y)) - plane(x, y), 2);
            }
        }
        // Rounding has an error of 0.29 steps.
        EXPECT_NEAR(std::sqrt(stored / (140 * 90)), 0.289, 0.03) << slope;
        EXPECT_LT(std::sqrt(squares / (140 * 90)), slope < 0.05 ? 0.12 : 0.06) << slope;
    }
}

/// Returns a value of a row beyond its ends: by the wrap mode, or point-reflected at the end for
/// Wrap::clamp.
double beyond(const std::vector<double>& row, int place, Wrap wrap) {
    const int count = static_cast<int>(row.size());
    if (place >= 0 && place < count) return row[static_cast<std::size_t>(place)];
    const int edge = place < 0 ? 0 : count - 1;
    switch (wrap) {
        case Wrap::repeat:
            return beyond(row, place + (place < 0 ? count : -count), wrap);
        case Wrap::mirror:
            return beyond(row, 2 * edge - place + (place < 0 ? -1 : 1), wrap);
        case Wrap::clamp:
            break;
    }
    return 2.0 * beyond(row, edge, wrap) - beyond(row, 2 * edge - place, wrap);
}

std::vector<double> binomial(const std::vector<double>& row, int spacing, Wrap wrap) {
    std::vector<double> result;
    for (int x = 0; x < static_cast<int>(row.size()); ++x) {
        double sum = 0.0;
        for (const auto& [offset, weight] : {std::pair(-2, 1), {-1, 4}, {0, 6}, {1, 4}, {2, 1}})
            sum += weight / 16.0 * beyond(row, x + offset * spacing, wrap);
        result.push_back(sum);
    }
    return result;
}

/// The algorithm of destaircase() for one row of integer codes, in a simple form, in steps.
std::vector<double> destaircased_row(const std::vector<double>& codes, Wrap wrap) {
    std::vector<double> heights = codes;
    std::vector<double> trust(codes.size(), 1.0);
    std::vector<double> low = binomial(codes, 1, wrap);
    double variance = 1.0;
    for (const int spacing : {2, 4, 8, 16, 32, 64}) {
        const std::vector<double> lower = binomial(low, spacing, wrap);
        const double added = spacing * spacing;
        std::vector<double> surface = low;
        std::vector<double> squares;
        for (std::size_t x = 0; x < codes.size(); ++x) {
            surface[x] += variance / added * (low[x] - lower[x]);
            squares.push_back(std::pow(surface[x] - codes[x], 2));
        }
        const std::vector<double> power =
            binomial(squares, spacing, wrap == Wrap::clamp ? Wrap::mirror : wrap);
        for (std::size_t x = 0; x < codes.size(); ++x) {
            // From 1 at the rounding error, 1/12, to 0 at 1.7 times that.
            trust[x] = std::clamp((1.7 - 12.0 * power[x]) / 0.7, 0.0, trust[x]);
            heights[x] += trust[x] * (surface[x] - heights[x]);
        }
        low = lower;
        variance += added;
    }
    for (std::size_t x = 0; x < codes.size(); ++x)
        heights[x] = std::clamp(heights[x], codes[x] - 0.49, codes[x] + 0.49);
    return heights;
}

TEST(Destaircase, FollowsTheSameSurfacesAsAPlainImplementation) {
    constexpr int count = 75;
    const auto code = [](int x) {
        return std::round(40.0 + 0.17 * x + 4.0 * std::sin(0.06 * x + 0.4) + (x > 50 ? 9.0 : 0.0));
    };
    std::vector<double> codes;
    for (int x = 0; x < count; ++x)
        codes.push_back(code(x));
    const Image row = in_8_bits(count, 1, [&](int x, int) { return code(x); });
    const Image column = in_8_bits(1, count, [&](int, int y) { return code(y); });
    for (const Wrap wrap : {Wrap::clamp, Wrap::mirror, Wrap::repeat}) {
        SCOPED_TRACE(static_cast<int>(wrap));
        const std::vector<double> expected = destaircased_row(codes, wrap);
        const Image rows = destaircase(row, {wrap, 1.0 / 255.0}).heights;
        const Image columns = destaircase(column, {wrap, 1.0 / 255.0}).heights;
        for (std::size_t x = 0; x < count; ++x) {
            // Sums of floats below 128 have an error of less than 2e-5 steps.
            EXPECT_NEAR(255.0 * static_cast<double>(rows.as<float>()[x]), expected[x], 1e-3) << x;
            EXPECT_EQ(columns.as<float>()[x], rows.as<float>()[x]) << x;
        }
    }
}

TEST(Destaircase, CliffsAndLevelGroundStayAsTheyAre) {
    const Image wall = in_8_bits(64, 48, [](int x, int) { return x < 30 ? 40.0 : 90.0; });
    const Image kept = destaircase(wall, {Wrap::mirror, 1.0 / 255.0}).heights;
    for (std::size_t i = 0; i < kept.sample_count(); ++i) {
        const auto stored = static_cast<float>(wall.as<std::uint8_t>()[i]);
        EXPECT_NEAR(255.0F * kept.as<float>()[i], stored, 0.03F) << i;
    }
    // On slopes next to a cliff, steps vanish and the cliff stays in its place.
    const auto slopes = [](int x, int y) { return 20.0 + 0.13 * y + (x < 30 ? 0.0 : 60.0); };
    const Destaircased smooth = destaircase(in_8_bits(64, 64, slopes), {Wrap::clamp});
    for (int y = 0; y < 64; ++y) {
        const float* const row = smooth.heights.as<float>().data() + y * 64;
        EXPECT_NEAR(255.0F * (row[30] - row[29]), 60.0F, 1.0F) << y;
    }
}

TEST(Destaircase, HolesStayAndTheirNeighborsAreSmoothedAllTheSame) {
    Image heights = heights_of(
        48, 40, [](int x, int y) { return std::round(3.0 + 0.21 * x + 0.11 * y) / 255.0; });
    const Image whole = destaircase(heights, {Wrap::clamp}).heights;
    heights.as<float>()[20 * 48 + 20] = std::numeric_limits<float>::quiet_NaN();
    heights.as<float>()[0] = -std::numeric_limits<float>::infinity();
    const Destaircased smooth = destaircase(heights, {Wrap::clamp});
    EXPECT_EQ(smooth.step, 1.0 / 255.0);
    for (std::size_t i = 0; i < 48 * 40; ++i) {
        const float found = smooth.heights.as<float>()[i];
        if (i == 20 * 48 + 20) {
            EXPECT_TRUE(std::isnan(found));
        } else if (i == 0) {
            EXPECT_EQ(found, -std::numeric_limits<float>::infinity());
        } else {
            EXPECT_NEAR(found, whole.as<float>()[i], 0.4F / 255.0F) << i;
        }
    }
}

TEST(Destaircase, AShiftedTilingMapGivesTheShiftedResultBitForBit) {
    const BumpField field = make_bump_field(tuning_fields()[3], 64, 64);
    Image shifted = field.heights;
    const auto at = [](int x, int y) {
        return static_cast<std::size_t>(((y + 64) % 64) * 64 + (x + 64) % 64);
    };
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x)
            shifted.as<std::uint8_t>()[at(x + 13, y - 7)] =
                field.heights.as<std::uint8_t>()[at(x, y)];
    }
    const Image one = destaircase(field.heights, {Wrap::repeat}).heights;
    const Image other = destaircase(shifted, {Wrap::repeat}).heights;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x)
            ASSERT_EQ(other.as<float>()[at(x + 13, y - 7)], one.as<float>()[at(x, y)]);
    }
}

TEST(Destaircase, TheNumberOfThreadsChangesNoBit) {
    const BumpField field = make_bump_field(tuning_fields()[3], 300, 500);
    const Image many = destaircase(field.heights, {Wrap::clamp}).heights;
    set_thread_limit(1);
    const Image one = destaircase(field.heights, {Wrap::clamp}).heights;
    set_thread_limit(0);
    EXPECT_EQ(one.samples, many.samples);
}

TEST_LABELS(not_sanitized);
TEST(Destaircase, TheBestKernelGainsOnSmoothMapsAndLosesLittleOnDetailedOnes) {
    for (const FieldRecipe& recipe : tuning_fields()) {
        if (recipe.coding != FieldCoding::bits8 || recipe.noise > 0.0) continue;
        BumpField field = make_bump_field(recipe, 192, 192);
        const double before = min_error(field);
        field.heights = destaircase(field.heights, {*field.options.wrap}).heights;
        const double gain = before / min_error(field);
        const bool is_smooth = recipe.shape == FieldShape::waves && recipe.shortest >= 16.0;
        EXPECT_GT(gain, is_smooth ? 1.2 : 0.85) << recipe.name;
    }
}

TEST(Destaircase, RefusesInvalidHeightFields) {
    EXPECT_THROW(destaircase(Image{}), InvalidInput);
    EXPECT_THROW(destaircase(make_image(4, 4, 3, 8, ColorSpace::data)), InvalidInput);
    EXPECT_THROW(destaircase(make_image(4, 4, 1, 8, ColorSpace::data), {Wrap::repeat, -1.0}),
                 InvalidInput);
}

}  // namespace
}  // namespace relief
