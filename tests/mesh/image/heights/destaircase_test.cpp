// SPDX-License-Identifier: Apache-2.0
// De-staircasing: its bound, what it must leave alone, what it recovers, and what it gains.
#include "relief/mesh/destaircase.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "relief/mesh/bump_fields.h"
#include "relief/mesh/error.h"
#include "relief/mesh/threads.h"
#include "support/height_fields.h"
#include "support/samples.h"

namespace relief {
namespace {

using test::heights_of;
using test::samples_of;
using testing::Each;
using testing::ElementsAreArray;

/// The heights as codes of 8 bits, 255 steps to 1.0.
Image in_8_bits(int width, int height, const std::function<double(int, int)>& steps) {
    Image codes = make_image(width, height, 1, 8, ColorSpace::data);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            codes.as<std::uint8_t>()[static_cast<std::size_t>(y * width + x)] =
                static_cast<std::uint8_t>(std::lround(steps(x, y)));
    }
    return codes;
}

DirectionError error_by(const BumpField& field, Kernel kernel, int radius) {
    BumpOptions options = field.options;
    options.kernel = kernel;
    options.gaussian_radius = radius;
    Report report;
    return field_error(normals_from_height(field.heights, options, report), field);
}

/// The least error that some kernel leaves.
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
    // From 0.02 to 1.3 steps a texel; up to the border, where clamping lets it go on as a plane.
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
        // Rounding itself is 0.29 steps off.
        EXPECT_NEAR(std::sqrt(stored / (140 * 90)), 0.289, 0.03) << slope;
        EXPECT_LT(std::sqrt(squares / (140 * 90)), slope < 0.05 ? 0.12 : 0.06) << slope;
    }
}

/// A value of a row beyond its ends: by the wrap, or for Wrap::clamp point-reflected at the end.
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

/// The algorithm of destaircase() for one row of whole codes, written plainly, in steps.
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
            // From 1 at the error of rounding, 1/12, to 0 at 1.7 times that.
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
    // On slopes beside one, steps go and the cliff stays where it is.
    const auto slopes = [](int x, int y) { return 20.0 + 0.13 * y + (x < 30 ? 0.0 : 60.0); };
    const Destaircased smooth = destaircase(in_8_bits(64, 64, slopes), {Wrap::clamp});
    for (int y = 0; y < 64; ++y) {
        const float* const row = smooth.heights.as<float>().data() + y * 64;
        EXPECT_NEAR(255.0F * (row[30] - row[29]), 60.0F, 1.0F) << y;
    }
}

TEST(Destaircase, HolesStayAndTheirNeighboursAreSmoothedAllTheSame) {
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

TEST(Destaircase, WhatIsNoHeightFieldIsRefused) {
    EXPECT_THROW(destaircase(Image{}), InvalidInput);
    EXPECT_THROW(destaircase(make_image(4, 4, 3, 8, ColorSpace::data)), InvalidInput);
    EXPECT_THROW(destaircase(make_image(4, 4, 1, 8, ColorSpace::data), {Wrap::repeat, -1.0}),
                 InvalidInput);
}

}  // namespace
}  // namespace relief
