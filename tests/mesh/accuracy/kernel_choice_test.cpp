// SPDX-License-Identifier: Apache-2.0
// The kernel that is chosen, against the best there is on fields whose truth is known; and what it
// says of maps without.
#include "relief/mesh/kernel_choice.h"
#include "relief/mesh/height_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "relief/mesh/bump_fields.h"
#include "relief/mesh/destaircase.h"
#include "relief/mesh/error.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/threads.h"
#include "support/height_fields.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using testing::HasSubstr;

/// What is promised: no more than a fifth above the best single kernel.
constexpr double promised = 1.2;
/// After de-staircasing, what is left of the steps is less regular than the rehearsal's.
constexpr double promised_destaircased = 1.3;

double error_by(const BumpField& field, Kernel kernel, int radius) {
    BumpOptions options = field.options;
    options.kernel = kernel;
    options.gaussian_radius = radius;
    options.arithmetic = Arithmetic::float64;
    Report report;
    return field_error(normals_from_height(field.heights, options, report), field).rms;
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

TEST_P(KernelChoiceOnFields, IsWithinAFifthOfTheBestKernel) {
    expect_promise_kept(GetParam(), 128, 128, false);
    expect_promise_kept(GetParam(), 256, 256, false);
    expect_promise_kept(GetParam(), 200, 200, false);
}

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

TEST(KernelChoice, SaysWhatItSawAndWhy) {
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
    EXPECT_THAT(walls.reason, HasSubstr("beside sharp walls"));
}

TEST(KernelChoice, ExpectsTheErrorThatThereIs) {
    // Where rounding and noise are white: within a half.
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

TEST(KernelChoice, ExpectsTheErrorOfNoiseOnMapsOfAnyWidth) {
    const FieldRecipe recipe{"", FieldShape::waves, 32.0, 0.3, FieldCoding::bits8, 1.0, 5};
    for (const int width : {128, 144, 160, 191, 192, 200, 256, 257}) {
        const BumpField field = make_bump_field(recipe, width, 128);
        const KernelChoice choice = choose_kernel(field.heights, field.options);
        const double error = error_by(field, choice.kernel, choice.gaussian_radius);
        EXPECT_NEAR(choice.rms_degrees / error, 1.0, 0.4) << width << ": " << choice.reason;
    }
}

TEST(KernelChoice, OfAConstantMapIsTheCheapestAndOfTinyMapsSomeKernel) {
    const Image flat = test::heights_of(64, 64, [](int, int) { return 0.25; });
    const KernelChoice choice = choose_kernel(flat, {});
    EXPECT_EQ(choice.kernel, Kernel::central3);
    EXPECT_EQ(choice.rms_degrees, 0.0);
    EXPECT_THAT(choice.reason, HasSubstr("every kernel is exact"));
    // The eight others and three radii: what is exact is not sought by wider and wider ones.
    EXPECT_EQ(choice.predictions.size(), 11U);
    for (const auto& [width, height] : {std::pair(1, 1), {1, 40}, {40, 1}, {7, 3}, {9, 11}}) {
        const KernelChoice tiny = choose_kernel(test::rough(width, height), {});
        // Too few texels say nothing of the error, unless all kernels are exact.
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

TEST(KernelChoice, LooksAtAFewPartsFromTopToBottom) {
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
        // They reach into the last third of both sides.
        EXPECT_GT(parts.back().x + parts.back().width, 2 * width / 3);
        EXPECT_GT(parts.back().y + parts.back().height, 2 * height / 3);
    }
}

TEST(KernelChoice, WhatAreNoPartsOfAHeightMapIsRefused) {
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
