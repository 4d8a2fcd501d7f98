// SPDX-License-Identifier: Apache-2.0
// relief-view --compare: which half shows what, the numbers, and what is refused.
#include "picture_comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "relief/mesh/image_file.h"
#include "tools/workplace.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

using nlohmann::json;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

constexpr const char* look_at_vase = "relief-view data/vase.obj --size 64x48 --samples 1 ";
constexpr const char* vase_heights = "--height-map data/bricks-height.png ";

TEST(Compare, EachHalfIsThePictureThatItsOptionsGive) {
    const Workplace workplace;
    ASSERT_EQ(workplace.run(std::string(look_at_vase) + vase_heights + "--output a.png").exit_code,
              0);
    ASSERT_EQ(
        workplace.run(std::string(look_at_vase) + vase_heights + "--kernel central5 --output b.png")
            .exit_code,
        0);
    const ProgramResult result =
        workplace.run(std::string(look_at_vase) + vase_heights +
                      "--compare kernel=central5 --split 0.25 --output sides.png --json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const Image a = read_image(workplace / "a.png", ImageUse::color);
    const Image b = read_image(workplace / "b.png", ImageUse::color);
    const Image sides = read_image(workplace / "sides.png", ImageUse::color);
    EXPECT_EQ(sides.samples, split_picture(a, b, 0.25F).samples);
    const json numbers = json::parse(result.out)["compare"];
    const ImageDifference difference = compare(a, b);
    EXPECT_EQ(numbers["with"], "kernel=central5");
    EXPECT_EQ(numbers["max"], difference.max);
    EXPECT_EQ(numbers["mean"], difference.mean);
    EXPECT_EQ(numbers["differing_pixels"], difference.differing_pixels);
    EXPECT_EQ(numbers["flip_mean"], flip_difference(a, b).mean);
    EXPECT_GT(difference.differing_pixels, 10U);
}

TEST(Compare, AnotherFileIsSeenFromTheSameEyeInTheSameLight) {
    const Workplace workplace;
    workplace.write("same.obj", workplace.read("data/vase.obj"));
    workplace.write_square("square.obj");
    const std::string line = std::string(look_at_vase) + "--output out/sides.png --compare-to ";
    const ProgramResult same = workplace.run(line + "same.obj");
    EXPECT_THAT(same.out, HasSubstr("compared  with same.obj: "));
    const ProgramResult other = workplace.run(line + "square.obj --difference-map out/map.exr");
    EXPECT_THAT(other.out, HasSubstr("pixels differ"));
    EXPECT_EQ(workplace.outputs(), "map.exr sides.png");
}

TEST(Compare, SplitsAtTheNearestColumn) {
    Image left = make_image(4, 1, 1, 8, ColorSpace::srgb);
    Image right = left;
    std::get<std::vector<std::uint8_t>>(left.samples) = {1, 2, 3, 4};
    std::get<std::vector<std::uint8_t>>(right.samples) = {5, 6, 7, 9};
    const auto split = [&](float at) {
        return std::get<std::vector<std::uint8_t>>(split_picture(left, right, at).samples);
    };
    EXPECT_THAT(split(0.0F), testing::ElementsAre(5, 6, 7, 9));
    EXPECT_THAT(split(0.3F), testing::ElementsAre(1, 6, 7, 9));
    EXPECT_THAT(split(1.0F), testing::ElementsAre(1, 2, 3, 4));
    const Image apart = largest_differences(left, right);
    EXPECT_FLOAT_EQ(apart.as<float>()[3], 5.0F / 255.0F);
}

TEST(CompareRefuses, OptionsWithoutEffect) {
    const Workplace workplace;
    test::expect_refusals(
        workplace, "relief-view", "picture.png",
        {{"relief-view data/vase.obj --split 0.5 --output out/picture.png", 2,
          "--split: needs --compare or --compare-to"},
         {"relief-view data/vase.obj --compare kernel=central3 --compare-to data/vase.obj "
          "--output out/picture.png",
          2, "--compare: contradicts --compare-to"},
         {"relief-view data/vase.obj --compare interpolation=flat --turntable 3 --output "
          "out/picture.png",
          2, "--compare: compares one picture, not a sequence"},
         {"relief-view data/vase.obj --compare interpolation=flat --explain-effects", 2,
          "--compare: there is no --output"},
         {"relief-view data/vase.obj --compare kernel=central3 --output out/picture.png", 2,
          "--compare kernel=central3: there is no height map"},
         {"relief-view data/vase.obj --compare interpolation=flat --difference-map out/m.png "
          "--output out/m.png",
          2, "--difference-map out/m.png: is also the input or the output"},
         {"relief-view data/vase.obj --compare-to none.obj --output out/picture.png", 1,
          "none.obj"}});
}

}  // namespace
}  // namespace relief::tools
