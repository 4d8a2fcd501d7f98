// SPDX-License-Identifier: Apache-2.0
// The C interface of normal maps: the results of C++, and wrong use.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "relief/mesh/bump.h"
#include "relief/mesh/normal_map.h"
#include "relief/relief.h"

namespace relief {
namespace {

using testing::HasSubstr;

constexpr int image_width = 70;
constexpr int image_height = 40;

std::vector<float> wave_heights() {
    std::vector<float> heights;
    for (int y = 0; y < image_height; ++y) {
        for (int x = 0; x < image_width; ++x)
            heights.push_back(0.5F + 0.3F * std::sin(0.2F * static_cast<float>(x + y * y / 9)));
    }
    return heights;
}

relief_image heights_view(const std::vector<float>& heights) {
    return {heights.data(), 0, image_width, image_height, 1, RELIEF_SAMPLE_FLOAT};
}

relief_bump_options sobel_options() {
    relief_bump_options options{};
    EXPECT_EQ(relief_bump_options_init(&options, sizeof(options)), RELIEF_OK);
    options.kernel = RELIEF_KERNEL_SOBEL3;
    options.wrap_x = RELIEF_WRAP_REPEAT;
    options.wrap_y = RELIEF_WRAP_CLAMP;
    options.strength = 5.0;
    options.green = RELIEF_GREEN_DOWN;
    return options;
}

TEST(CImages, NormalMapsAreThoseOfCpp) {
    const std::vector<float> heights = wave_heights();
    const relief_image from = heights_view(heights);
    const relief_bump_options options = sobel_options();
    BumpOptions same;
    same.kernel = Kernel::sobel3;
    same.wrap = Wraps(Wrap::repeat, Wrap::clamp);
    same.strength = 5.0;
    const NormalMapFormat format{.bits = 16, .green = Green::down};
    Image expected = make_image(image_width, image_height, 3, 16, ColorSpace::data);
    normal_map_from_height(ImageView(heights.data(), image_width, image_height), same, format,
                           MutableImageView(expected));
    // The bottom row is first in memory, and each row has an unused sample.
    constexpr std::size_t row_size = 3 * image_width + 1;
    std::vector<std::uint16_t> texels(row_size * image_height, 7);
    const relief_output_image map = {&texels[row_size * (image_height - 1)],
                                     -static_cast<std::ptrdiff_t>(2 * row_size),
                                     image_width,
                                     image_height,
                                     3,
                                     RELIEF_SAMPLE_UINT16};
    ASSERT_EQ(relief_normal_map_from_height(&from, &options, nullptr, &map, nullptr), RELIEF_OK)
        << relief_last_error();
    for (int y = 0; y < image_height; ++y) {
        const std::uint16_t* const row =
            &texels[row_size * static_cast<std::size_t>(image_height - 1 - y)];
        ASSERT_TRUE(
            std::equal(row, row + 3 * image_width, ImageView(expected).row<std::uint16_t>(y)))
            << y;
        ASSERT_EQ(row[3 * image_width], 7);
    }
}

TEST(CImages, AutomaticOptionsAreResolved) {
    const std::vector<float> heights = wave_heights();
    const relief_image from = heights_view(heights);
    relief_bump_options options{};
    ASSERT_EQ(relief_bump_options_init(&options, sizeof(options)), RELIEF_OK);
    ASSERT_EQ(relief_resolve_bump_options(&from, &options), RELIEF_OK) << relief_last_error();
    const BumpOptions resolved =
        resolve_options(ImageView(heights.data(), image_width, image_height), {});
    EXPECT_EQ(options.kernel, static_cast<int>(*resolved.kernel));
    EXPECT_EQ(options.gaussian_radius, resolved.gaussian_radius);
    EXPECT_EQ(options.wrap_x, static_cast<int>(resolved.wrap->x));
    EXPECT_EQ(options.wrap_y, static_cast<int>(resolved.wrap->y));
    EXPECT_EQ(options.strength, 16.0);
    EXPECT_EQ(relief_resolve_bump_options(&from, nullptr), RELIEF_INVALID_INPUT);
}

TEST(CImages, HolesAreReported) {
    std::vector<float> heights = wave_heights();
    heights[5] = std::numeric_limits<float>::quiet_NaN();
    const relief_image from = heights_view(heights);
    std::vector<std::uint8_t> texels(4 * heights.size());
    const relief_output_image map = {texels.data(), 0, image_width,
                                     image_height,  4, RELIEF_SAMPLE_UINT8};
    relief_report* const report = relief_report_create();
    EXPECT_EQ(relief_normal_map_from_height(&from, nullptr, nullptr, &map, report), RELIEF_OK);
    EXPECT_EQ(relief_report_count(report), 1U);
    relief_report_destroy(report);
    for (std::size_t i = 3; i < texels.size(); i += 4)
        ASSERT_EQ(texels[i], 255);
}

struct WrongImages {
    const char* message;
    std::function<void(relief_image& height, relief_bump_options& options,
                       relief_output_image& map)>
        change;
};

TEST(CImages, RefuseWrongUse) {
    const WrongImages rows[] = {
        {"the height map is NULL", [](auto& height, auto&, auto&) { height.pixels = nullptr; }},
        {"the height map has 0 x 40 texels, but must have 1 to",
         [](auto& height, auto&, auto&) { height.width = 0; }},
        {"the height map has 70 x -1 texels",
         [](auto& height, auto&, auto&) { height.height = -1; }},
        {"the height map has 5 channels, but must have 1 to 4",
         [](auto& height, auto&, auto&) { height.channels = 5; }},
        {"sample_type is 4, but must be within 0 to 2",
         [](auto& height, auto&, auto&) { height.sample_type = 4; }},
        {"the row stride of the height map is 276 bytes, but a row has 280",
         [](auto& height, auto&, auto&) { height.row_stride = 276; }},
        {"the row stride of the height map is -276 bytes, but a row has 280",
         [](auto& height, auto&, auto&) { height.row_stride = -276; }},
        {"with the row stride 282, but both must be multiples of 4",
         [](auto& height, auto&, auto&) { height.row_stride = 282; }},
        {"the normal map is NULL", [](auto&, auto&, auto& map) { map.pixels = nullptr; }},
        {"of 1 channels with 8 bits, but must have 70 x 40 of 2 to 4 with 8",
         [](auto&, auto&, auto& map) { map.channels = 1; }},
        {"has 70 x 39 texels", [](auto&, auto&, auto& map) { map.height = 39; }},
        {"the normal map overlap the height map",
         [](auto& height, auto&, auto& map) { map.pixels = const_cast<void*>(height.pixels); }},
        {"kernel is 10, but must be within 0 to 9",
         [](auto&, auto& options, auto&) { options.kernel = 10; }},
        {"dither is -1, but must be within 0 to 2",
         [](auto&, auto& options, auto&) { options.dither = -1; }},
        {"wrap_x and wrap_y must both be automatic, or neither",
         [](auto&, auto& options, auto&) { options.wrap_y = RELIEF_WRAP_AUTOMATIC; }},
        {"the strength is nan", [](auto&, auto& options, auto&) { options.strength = NAN; }},
        {"the texel size is 0", [](auto&, auto& options, auto&) { options.texel_width = 0.0; }},
        {"relief_bump_options: the size is 1",
         [](auto&, auto& options, auto&) { options.size = 1; }},
    };
    std::vector<float> heights = wave_heights();
    std::vector<std::uint8_t> texels(4 * heights.size());
    for (const WrongImages& row : rows) {
        SCOPED_TRACE(row.message);
        relief_image from = heights_view(heights);
        relief_bump_options options = sobel_options();
        relief_output_image map = {texels.data(), 0, image_width,
                                   image_height,  3, RELIEF_SAMPLE_UINT8};
        row.change(from, options, map);
        EXPECT_EQ(relief_normal_map_from_height(&from, &options, nullptr, &map, nullptr),
                  RELIEF_INVALID_INPUT);
        EXPECT_THAT(relief_last_error(), HasSubstr(row.message));
    }
}

}  // namespace
}  // namespace relief
