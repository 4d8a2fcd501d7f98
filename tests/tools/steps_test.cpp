// SPDX-License-Identifier: Apache-2.0
// relief-view --steps: the strip, numbered files, and what the summary says of each step.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

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

TEST(Steps, AreOneStripThatEndsWithThePicture) {
    const Workplace workplace;
    const std::string line =
        "relief-view data/scenes/environment-mapping.json --size 60x40 --output out/";
    ASSERT_EQ(workplace.run(line + "picture.png").exit_code, 0);
    const ProgramResult result = workplace.run(line + "steps.png --steps");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("3 highlights: the mirror images of light sources (FLIP "));
    EXPECT_THAT(result.out, HasSubstr("out/steps.png"));
    const Image strip = picture_in(workplace / "out/steps.png");
    EXPECT_EQ(strip.width, 7 * 60);
    EXPECT_EQ(strip.height, 40);
    const Image picture = picture_in(workplace / "out/picture.png");
    EXPECT_EQ(part_of(strip, 6 * 60, 0, 60, 40).samples, picture.samples);
    EXPECT_NE(part_of(strip, 5 * 60, 0, 60, 40).samples, picture.samples);

    ASSERT_EQ(workplace.run(line + "step-#.png --steps --json").exit_code, 0);
    EXPECT_EQ(workplace.outputs(),
              "picture.png step-1.png step-2.png step-3.png step-4.png step-5.png step-6.png "
              "step-7.png steps.png");
    EXPECT_EQ(picture_in(workplace / "out/step-7.png").samples, picture.samples);
    EXPECT_EQ(picture_in(workplace / "out/step-2.png").samples,
              part_of(strip, 60, 0, 60, 40).samples);
}

TEST(Steps, AreInTheJsonWithTheirPartsAndChanges) {
    const Workplace workplace;
    const ProgramResult result = workplace.run(
        "relief-view data/vase.obj --size 32x32 --tone-mapping aces --steps --output out/a.png "
        "--json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const json steps = json::parse(result.out)["steps"];
    ASSERT_EQ(steps.size(), 4U) << steps.dump(1);
    EXPECT_EQ(steps[0]["name"], "diffuse");
    EXPECT_TRUE(steps[0]["change"].is_null());
    EXPECT_EQ(steps[1]["name"], "highlights");
    EXPECT_EQ(steps[1]["effects"], json({"Blinn-Phong highlights"}));
    EXPECT_THAT(steps[1]["parts"].dump(), HasSubstr("phong.glsl#blinn_phong"));
    EXPECT_GT(steps[1]["change"]["flip_mean"], 0.0);
    EXPECT_EQ(steps[2]["name"], "maps");
    EXPECT_EQ(steps[3]["name"], "tone curve");
    EXPECT_THAT(steps[3]["parts"].dump(), HasSubstr("tone.glsl#aces"));
}

TEST(Steps, RefuseWhatTheyContradict) {
    const Workplace workplace;
    expect_refusals(workplace, "relief-view", "old.png",
                    {{"data/vase.obj --steps --save-scene out/old.png", 2,
                      "--steps: there is no --output (add one; the window has a slider for steps)"},
                     {"data/vase.obj --steps --turntable 3 --output out/old.png", 2,
                      "--steps: applies to one picture, not to a sequence"},
                     {"data/vase.obj --steps --show diffuse --output out/old.png", 2,
                      "--steps: chooses the effects of its pictures itself"},
                     {"data/vase.obj --steps --compare interpolation=flat --output out/old.png", 2,
                      "--steps: draws several pictures, which are not compared with others"}});
}

}  // namespace
}  // namespace relief::tools
