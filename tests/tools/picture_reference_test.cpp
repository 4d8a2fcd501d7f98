// SPDX-License-Identifier: Apache-2.0
// relief-view against a picture that is known to be right: when it matches, when not, and what it
// says and writes then.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/shade/image_compare.h"
#include "tools/workplace.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

/// Draws a square in 33 x 33 pixels.
constexpr const char* look_at_square =
    "relief-view square.obj --camera 0,0 --size 33x33 --samples 1 ";

/// A workplace with the square and its picture, right.png (sRGB) or right.exr.
class Reference : public testing::Test {
  protected:
    void SetUp() override {
        workplace_.write_square("square.obj");
        ASSERT_EQ(run("--output right.png --quiet").exit_code, 0);
    }

    [[nodiscard]] ProgramResult run(const std::string& options) const {
        return workplace_.run(look_at_square + options);
    }

    /// right.png with 5 added to one sample, as near.png.
    void write_near() const {
        Image image = read_image(workplace_ / "right.png", ImageUse::color);
        image.as<std::uint8_t>()[3 * (33 * 16 + 16) + 1] -= 5;
        write_image(workplace_ / "near.png", image);
    }

    Workplace workplace_;
};

TEST_F(Reference, ThatIsTheSamePictureMatches) {
    const ProgramResult result = run("--reference right.png");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("compared  no difference\n"));
    EXPECT_THAT(result.out, testing::Not(HasSubstr("wrote")));
    EXPECT_EQ(run("--reference right.png --quiet").out, "");
}

TEST_F(Reference, ThatDiffersByMoreThanAllowedIsAnErrorAndByLessNone) {
    write_near();
    const ProgramResult result = run("--reference near.png --output out/new.png");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.error,
              "relief-view: error: near.png: the picture differs by 5 of 255, and "
              "--max-difference allows 0 (--difference-map FILE shows where)\n");
    EXPECT_THAT(result.out, HasSubstr("compared  largest 5 of 255, mean 0.00153, PSNR "));
    EXPECT_THAT(result.out, HasSubstr(", 1 pixel differs\n"));
    EXPECT_EQ(workplace_.outputs(), "new.png") << "to look at";
    EXPECT_EQ(run("--reference near.png --max-difference 4").exit_code, 1);
    EXPECT_EQ(run("--reference near.png --max-difference 5").exit_code, 0);
}

TEST_F(Reference, AndItsNumbersAreInTheJson) {
    write_near();
    const ProgramResult result = run("--reference near.png --json --difference-map out/map.png");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, HasSubstr("(out/map.png shows where)"));
    const json comparison = json::parse(result.out)["comparison"];
    EXPECT_EQ(comparison["matches"], false);
    EXPECT_EQ(comparison["max"], 5.0);
    EXPECT_EQ(comparison["differing_pixels"], 1);
    EXPECT_NEAR(comparison["psnr"].get<double>(), 20.0 * std::log10(255.0 * 57.1576 / 5.0), 0.01)
        << "one of 3267 samples";
    EXPECT_GT(comparison["flip_max"], comparison["flip_mean"]);
    EXPECT_EQ(comparison["difference_map"], "out/map.png");
    const json same = json::parse(run("--reference right.png --json").out);
    EXPECT_EQ(same["comparison"]["matches"], true);
    EXPECT_TRUE(same["comparison"]["psnr"].is_null());
    EXPECT_TRUE(same["picture"]["output"].is_null());
}

TEST_F(Reference, WritesAMapOfVisibleDifferences) {
    write_near();
    EXPECT_EQ(run("--reference near.png --max-difference 9 --quiet --difference-map out/map.png "
                  "--output out/new.png")
                  .exit_code,
              0);
    EXPECT_EQ(run("--reference near.png --max-difference 9 --quiet --difference-map out/map.exr")
                  .exit_code,
              0);
    const Image colors = read_image(workplace_ / "out/map.png", ImageUse::color);
    const Image numbers = read_image(workplace_ / "out/map.exr", ImageUse::data);
    const FlipDifference flip =
        flip_difference(read_image(workplace_ / "near.png", ImageUse::color),
                        read_image(workplace_ / "out/new.png", ImageUse::color));
    EXPECT_EQ(compare(colors, false_color_image(flip.map, 1.0)).max, 0.0);
    EXPECT_EQ(compare(numbers, flip.map).max, 0.0);
    EXPECT_GT(flip.max, 0.0);
}

TEST_F(Reference, LinearPicturesAreComparedInLinearLight) {
    ASSERT_EQ(run("--output right.exr --quiet --light directional:0,0,10").exit_code, 0);
    EXPECT_EQ(run("--reference right.exr --light directional:0,0,10").exit_code, 0);
    const ProgramResult brighter = run("--reference right.exr --light directional:0,0,11");
    EXPECT_EQ(brighter.exit_code, 1);
    // 0.8 times one step of intensity; a screen shows both as white.
    EXPECT_THAT(brighter.error, HasSubstr("the picture differs by 0.8"));
    EXPECT_THAT(brighter.out, HasSubstr("FLIP 0 (largest 0)"));
}

TEST_F(Reference, WithFullAlphaIsTheSameAsWithout) {
    const Image opaque = read_image(workplace_ / "right.png", ImageUse::color);
    Image covered = make_image(33, 33, 4, 8, ColorSpace::srgb);
    for (std::size_t i = 0; i < covered.sample_count(); ++i) {
        covered.as<std::uint8_t>()[i] =
            i % 4 == 3 ? 255 : opaque.as<std::uint8_t>()[i / 4 * 3 + i % 4];
    }
    write_image(workplace_ / "covered.png", covered);
    EXPECT_EQ(run("--reference covered.png").exit_code, 0);
    EXPECT_EQ(run("--reference right.png --background transparent").exit_code, 1)
        << "the reference has a background there";
}

TEST(ReferenceRefusal, StatesTheReasonAndWritesNoFile) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    write_image(workplace / "small.png", make_image(8, 4, 3, 8, ColorSpace::srgb));
    write_image(workplace / "words.png", make_image(8, 4, 3, 16, ColorSpace::srgb));
    write_image(workplace / "linear.exr", make_image(8, 4, 3, 32, ColorSpace::linear));
    expect_refusals(
        workplace, "relief-view", "old.png",
        {{"square.obj --output out/old.png --max-difference 2", 2,
          "--max-difference: there is no --reference to compare with (give one, or leave it "
          "out)"},
         {"square.obj --output out/old.png --difference-map out/map.png", 2,
          "--difference-map: there is no --reference to compare with"},
         {"square.obj --reference small.png --max-difference -1", 2,
          "--max-difference -1: not between 0 and 65535"},
         {"square.obj --reference out/old.png --output ./out/old.png", 2,
          "--output ./out/old.png: is also the input or the output"},
         {"square.obj --normal-map small.png --output small.png", 2,
          "--output small.png: is also the input or the output"},
         {"square.obj --reference small.png --difference-map small.png", 2,
          "--difference-map small.png: is also the input or the output"},
         {"square.obj --reference small.png --difference-map out/map.jpg", 2,
          "--difference-map out/map.jpg: unsupported format"},
         {"square.obj --reference linear.exr --output out/old.png", 2,
          "--reference linear.exr: sRGB and linear colors cannot be compared"},
         {"square.obj --reference missing.png", 1, "missing.png: "},
         {"square.obj --reference small.png --output out/old.png", 1,
          "small.png: has 8 x 4 pixels, but the picture has 1024 x 1024 (add "
          "--size 8x4)"},
         {"square.obj --reference words.png --size 8x4", 1,
          "words.png: images cannot be compared: "},
         {"square.obj --reference small.png --difference-map nowhere/map.png", 1,
          "nowhere/map.png: "}});
}

}  // namespace
}  // namespace relief::tools
