// SPDX-License-Identifier: Apache-2.0
// The HTML page of `relief make`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "make_pictures.h"
#include "support/labels.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++count;
    return count;
}

TEST(MakePage, HasPicturesTablesAndTheCommandAndLoadsNothing) {
    const Workplace workplace;
    const ProgramResult result = workplace.run(
        "relief make data/urn-high.ply out/urn.glb --triangles 400 --size 64 --padding 2 "
        "--occlusion-rays 2 --lods 1 --layers height --report out/urn.html");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(workplace.outputs(), "urn.glb urn.html urn_height.png");
    const std::string page = workplace.read("out/urn.html");
    EXPECT_THAT(page,
                HasSubstr("urn-high.ply: 26800 triangles became 400 triangles, with maps of 64 "
                          "x 64 texels."));
    EXPECT_GE(count_of(page,
                       "relief make data/urn-high.ply -o out/urn.glb --triangles 400 "
                       "--crease 60 --lods 1 "),
              1U);
    for (const char* text :
         {"<th scope=\"row\">decimate</th>", "<th scope=\"row\">LOD1</th>", "normals, 64 x 64",
          "occlusion, 16 x 16", "height map, 64 x 64", "alt=\"source\""})
        EXPECT_GE(count_of(page, text), 1U);
    // Four of the models, the charts and three maps.
    EXPECT_EQ(count_of(page, "src=\"data:image/png;base64,"), 8U);
    for (const char* address : {"http://", "https://"})
        EXPECT_EQ(page.find(address), std::string::npos) << address;
    EXPECT_EQ(page.find("{{"), std::string::npos);
    EXPECT_EQ(count_of(page, "<iframe title=\"the models, to be orbited\""), 1U);
    EXPECT_LT(page.size(), 3'000'000U);
}

TEST_LABELS(not_sanitized);
TEST(MakePage, LeavesTheLiveViewOut) {
    const Workplace workplace;
    workplace.write_square("out/square.obj");
    const std::string line =
        "relief make out/square.obj out/a.glb --size 32 --padding 2 --occlusion-rays 0 "
        "--no-live-view";
    const ProgramResult result = workplace.run(line + " --report out/a.html");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(count_of(workplace.read("out/a.html"), "<iframe"), 0U);
    const ProgramResult useless = workplace.run(line + " --report out/a.json");
    EXPECT_EQ(useless.exit_code, 2);
    EXPECT_THAT(useless.error, HasSubstr("--no-live-view: needs the report page of one asset"));
}

TEST_LABELS(not_sanitized);
TEST(MakePage, HasTheMeasuredLoss) {
    const Workplace workplace;
    workplace.write_square("out/square.obj");
    const std::string line =
        "relief make out/square.obj out/a.glb --size 32 --padding 2 --occlusion-rays 0 --loss";
    ProgramResult result =
        workplace.run(line + " --max-error 1 --max-error-kind mean --report out/a.html");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("FLIP, studio"));
    const std::string page = workplace.read("out/a.html");
    EXPECT_EQ(count_of(page, "<h2>What was lost</h2>"), 1U);
    EXPECT_EQ(count_of(page, "; --max-error 1 held</li>"), 1U);
    for (const char* row : {"FLIP, studio", "FLIP, grazing", "FLIP, base-color", "normals, degrees",
                            "silhouettes, pixels"})
        EXPECT_EQ(count_of(page, std::string("<th scope=\"row\">") + row + "</th>"), 1U) << row;
    for (const char* text : {"<h3>After each stage</h3>", "<th scope=\"row\">decimated</th>",
                             "<th scope=\"row\">baked</th>", "<th scope=\"row\">coded</th>",
                             "<th scope=\"row\">source to asset</th>", "degrees, 99 %",
                             "All views, the worst first", "alt=\"FLIP, studio\""})
        EXPECT_EQ(count_of(page, text), 1U) << text;
    // The asset of a square is the same square, also in its color. The codes of its normal map are
    // 0.32 degrees from flat.
    result = workplace.run(line + " --max-error 1 --max-error-kind mean --report out/a.json");
    const nlohmann::json report = nlohmann::json::parse(workplace.read("out/a.json"));
    EXPECT_EQ(report["limits"]["attempts"].size(), 1U);
    const nlohmann::json& loss = report["loss"];
    EXPECT_EQ(loss["views"], 12);
    for (const nlohmann::json& figure : loss["figures"]) {
        const bool is_flip = figure["name"].get<std::string>().starts_with("FLIP");
        EXPECT_LT(figure["mean"].get<double>(), is_flip ? 0.05 : 0.6) << figure;
    }
    // Only the codes lose something.
    const nlohmann::json& stages = loss["stages"];
    ASSERT_EQ(stages.size(), 3U);
    EXPECT_LT(stages[0]["degrees"]["mean"].get<double>(), 0.01);
    EXPECT_LT(stages[1]["degrees"]["mean"].get<double>(), 0.01);
    EXPECT_GT(stages[2]["degrees"]["mean"].get<double>(), 0.1);
    EXPECT_EQ(stages[2]["distance_from_source"]["max"], 0.0);
    EXPECT_EQ(loss["by_view"].size(), 12U);
}

TEST(ReducedPicture, HasTheMeanOfEachSquare) {
    Image image;
    image.width = 4;
    image.height = 2;
    image.channels = 1;
    image.samples = std::vector<std::uint8_t>{0, 2, 10, 10, 4, 6, 10, 14};
    const Image small = reduced(image, 2);
    EXPECT_EQ(small.width, 2);
    EXPECT_EQ(small.height, 1);
    EXPECT_EQ(std::get<std::vector<std::uint8_t>>(small.samples),
              (std::vector<std::uint8_t>{3, 11}));
    EXPECT_EQ(reduced(image, 4).width, 4);
    // Sixteen bits become eight.
    image.samples = std::vector<std::uint16_t>{0, 514, 2570, 2570, 1028, 1542, 2570, 3598};
    EXPECT_EQ(std::get<std::vector<std::uint8_t>>(reduced(image, 2).samples),
              (std::vector<std::uint8_t>{3, 11}));
    EXPECT_EQ(std::get<std::vector<std::uint8_t>>(reduced(image, 4).samples)[1], 2);
}

}  // namespace
}  // namespace relief::tools
