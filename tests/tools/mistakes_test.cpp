// SPDX-License-Identifier: Apache-2.0
// relief-view --mistake: the pictures, the sheet, the cost in text and JSON, and refusals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>

#include "relief/mesh/image.h"
#include "support/labels.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

FILE_LABELS(cli);

using nlohmann::json;
using test::expect_refusals;
using test::part_of;
using test::picture_in;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

const std::string scene_line = "relief-view data/scenes/mistakes.json --size 120x38 ";

TEST(MistakeOption, AllMistakesShowInTheirScene) {
    const Workplace workplace;
    ASSERT_EQ(workplace.run(scene_line + "--output out/right.png").exit_code, 0);
    const ProgramResult result =
        workplace.run(scene_line + "--mistake all --json --output out/sheet.png");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const json all = json::parse(result.out)["mistakes"];
    ASSERT_EQ(all.size(), 13U);
    for (const json& each : all) {
        SCOPED_TRACE(each.dump());
        EXPECT_TRUE(each["shows"]);
        EXPECT_TRUE(each["reason"].is_null());
        EXPECT_GT(each["surfaces"], 0);
        EXPECT_EQ(each["of"], 4);
        EXPECT_GT(each["change"]["flip_mean"], 0.0005);
        EXPECT_GT(each["changed_share"], 0.005);
        EXPECT_LE(each["changed_share"], 1.0);
        if (each["angles"].is_null()) continue;
        EXPECT_GT(each["angles"]["max"], 5.0);
        EXPECT_LE(each["angles"]["mean"], each["angles"]["p99"]);
    }
    const Image sheet = picture_in(workplace / "out/sheet.png");
    ASSERT_EQ(sheet.width, 3 * 120);
    ASSERT_EQ(sheet.height, 13 * 38);
    const Image right = picture_in(workplace / "out/right.png");
    for (int row = 0; row < 13; ++row) {
        EXPECT_EQ(part_of(sheet, 0, 38 * row, 120, 38).samples, right.samples);
        EXPECT_NE(part_of(sheet, 120, 38 * row, 120, 38).samples, right.samples);
    }

    // One mistake is drawn as it is in the sheet, and numbered files have the wrong pictures.
    ASSERT_EQ(workplace.run(scene_line + "--mistake green --output out/green.png").exit_code, 0);
    const Image green = picture_in(workplace / "out/green.png");
    EXPECT_EQ(all[5]["name"], "green");
    EXPECT_EQ(part_of(sheet, 120, 38 * 5, 120, 38).samples, green.samples);
    const ProgramResult numbered =
        workplace.run(scene_line + "--mistake srgb,green --output out/wrong-#.png");
    ASSERT_EQ(numbered.exit_code, 0) << numbered.error;
    EXPECT_THAT(numbered.out, HasSubstr("out/wrong-1.png to out/wrong-2.png"));
    EXPECT_EQ(picture_in(workplace / "out/wrong-2.png").samples, green.samples);
    EXPECT_NE(picture_in(workplace / "out/wrong-1.png").samples, green.samples);
}

TEST(MistakeOption, PrintsTheCostWithoutAPicture) {
    const Workplace workplace;
    const ProgramResult result = workplace.run(scene_line + "--mistake normal-matrix");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("normal-matrix: normals are transformed by the matrix"));
    EXPECT_THAT(result.out, HasSubstr("normal-matrix: FLIP 0."));
    EXPECT_THAT(result.out, HasSubstr("% of the pixels change, normal off by "));
    EXPECT_THAT(result.out, HasSubstr("on 1 of 4 surfaces"));
    EXPECT_THAT(result.out, Not(HasSubstr("wrote")));
    EXPECT_EQ(workplace.outputs(), "");
}

TEST(MistakeOption, SaysWhyAMistakeDoesNotShow) {
    const Workplace workplace;
    const ProgramResult result =
        workplace.run("relief-view data/scenes/shading-lights.json --size 60x25 --mistake all");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out,
                HasSubstr("green: does not show: no surface shows a normal map in tangent space"));
    EXPECT_THAT(result.out, HasSubstr("gamma-twice: FLIP 0."));
    EXPECT_THAT(workplace.run("relief-view data/scenes/shading-lights.json --mistake green").error,
                HasSubstr("--mistake green: would change nothing, because no surface shows a "
                          "normal map in tangent space (--mistake all lists those that show)"));
}

TEST(MistakeOption, SaysThatTheCameraSeesNoChange) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    workplace.write("card.json", R"({"relief_scene": 1, "ambient": 0.1,
        "nodes": [{"model": "square.obj", "material": {"diffuse": 0.5, "double_sided": true}}],
        "lights": [{"type": "directional", "direction": [0.2, -0.3, -1]}]})");
    const std::string line = "relief-view card.json --size 40x40 --mistake back-faces ";
    // The front is right whether back faces flip their normals or not; the light is before it.
    const ProgramResult front = workplace.run(line + "--camera 0,0");
    ASSERT_EQ(front.exit_code, 0) << front.error;
    EXPECT_THAT(front.out, HasSubstr("back-faces: changes no pixel that this camera sees, on 1 of "
                                     "1 surface\n"));
    const json numbers =
        json::parse(workplace.run(line + "--camera 0,0 --json").out)["mistakes"][0];
    EXPECT_TRUE(numbers["shows"]);
    EXPECT_EQ(numbers["changed_share"], 0.0);
    EXPECT_EQ(numbers["change"]["flip_mean"], 0.0);
    // From behind, the wrong normal is that of the lit front.
    const ProgramResult back = workplace.run(line + "--camera 180,0");
    ASSERT_EQ(back.exit_code, 0) << back.error;
    EXPECT_THAT(back.out, HasSubstr("% of the pixels change, normal off by 180 degrees"));
    EXPECT_THAT(back.out, Not(HasSubstr("changes no pixel")));
}

TEST(MistakeOption, WritesItsDifference) {
    const Workplace workplace;
    ASSERT_EQ(workplace
                  .run(scene_line +
                       "--mistake back-faces --output out/a.exr --difference-map out/map.png")
                  .exit_code,
              0);
    EXPECT_EQ(workplace.outputs(), "a.exr map.png");
    // With alpha, too.
    ASSERT_EQ(workplace
                  .run(scene_line + "--background transparent --mistake back-faces,green --output "
                                    "out/sheet.png")
                  .exit_code,
              0);
    EXPECT_EQ(picture_in(workplace / "out/sheet.png").channels, 4);
}

TEST(MistakeOption, RefusesWhatItContradicts) {
    const Workplace workplace;
    const std::string scene = "data/scenes/mistakes.json --mistake green ";
    expect_refusals(
        workplace, "relief-view", "old.png",
        {{"data/vase.obj --mistake gren", 2,
          "--mistake gren: 'gren' is not one of all, normal-matrix"},
         {"data/vase.obj --mistake green,green", 2,
          "--mistake green,green: 'green' is named twice"},
         {scene + "--turntable 3 --output out/old.png", 2,
          "--mistake: applies to one picture, not to a sequence"},
         {scene + "--compare interpolation=flat --output out/old.png", 2,
          "--mistake: compares with the picture without the mistake"},
         {scene + "--steps --output out/old.png", 2,
          "--mistake: compares with the picture without the mistake"},
         {scene + "--show diffuse --output out/old.png", 2,
          "--mistake: draws the picture with the effects of the scene"},
         {scene + "--probe 3,3", 2, "--mistake: contradicts --probe"},
         {scene + "--print-shaders", 2, "--mistake: contradicts --print-shaders"},
         {scene + "--output out/old.html", 2, "--mistake: applies to pictures, not to pages"},
         {"data/scenes/mistakes.json --mistake all --output out/old.exr", 2,
          "--mistake: the sheet of several mistakes has display colors"}});
}

}  // namespace
}  // namespace relief::tools
