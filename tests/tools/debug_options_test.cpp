// SPDX-License-Identifier: Apache-2.0
// --show, --wireframe, --vertex-frames and --health-markers as users write them: what they draw,
// say and refuse.
#include "effect_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "relief/mesh/image_file.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

class DebugOptions : public testing::Test {
  protected:
    void SetUp() override { workplace_.write_square("square.obj"); }

    [[nodiscard]] ProgramResult run(const std::string& options) const {
        return workplace_.run("relief-view square.obj --camera 0,0 --size 32x32 " + options);
    }

    [[nodiscard]] Image picture(const std::string& options) const {
        const ProgramResult result = run(options + " --output p.png --quiet");
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return read_image(workplace_ / "p.png", ImageUse::data);
    }

    Workplace workplace_;
};

glm::ivec3 middle(const Image& image) {
    const auto& codes = std::get<std::vector<std::uint8_t>>(image.samples);
    const std::size_t at = (16U * 32U + 16U) * static_cast<std::size_t>(image.channels);
    return {codes[at], codes[at + 1], codes[at + 2]};
}

TEST_F(DebugOptions, ShowTheRequestedView) {
    EXPECT_EQ(middle(picture("--show handedness")), glm::ivec3(51, 153, 255));
    const glm::ivec3 normal = middle(picture("--show geometric-normal"));
    EXPECT_NEAR(normal.x, 127.5, 0.5);
    EXPECT_EQ(normal.z, 255);
    EXPECT_EQ(middle(picture("--show overdraw")), glm::ivec3(64, 16, 4));
}

TEST_F(DebugOptions, TakeOneSampleForDataAndSaySo) {
    const ProgramResult result = run("--show tangent --output t.png --json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(json::parse(result.out)["picture"]["samples"], 1);
}

TEST_F(DebugOptions, ExplainEmptyViews) {
    const ProgramResult result = run("--show height --output h.png");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, HasSubstr("square.obj: height cannot be shown"));
    EXPECT_THAT(result.error, HasSubstr("(give --height-map with --height-as bump_map)"));
    EXPECT_FALSE(std::filesystem::exists(workplace_ / "h.png"));
}

TEST_F(DebugOptions, GiveALegendOfMarkers) {
    const ProgramResult text = run("--health-markers all --output m.png");
    ASSERT_EQ(text.exit_code, 0) << text.error;
    EXPECT_THAT(text.out, HasSubstr("boundary edge: 4"));
    const ProgramResult result = run("--health-markers all --output m.png --json");
    const json markers = json::parse(result.out)["markers"];
    ASSERT_EQ(markers.size(), 1U);
    EXPECT_EQ(markers[0]["kind"], "boundary edge");
    EXPECT_EQ(markers[0]["count"], 4);
    EXPECT_THAT(run("--health-markers problems --output m.png").out, HasSubstr("markers   none"));
}

TEST_F(DebugOptions, PrintTheShadersOfTheView) {
    const ProgramResult result = run("--show texcoords --print-shaders");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("view of texcoords"));
    EXPECT_THAT(result.out, HasSubstr("view.glsl#texcoords"));
}

TEST_F(DebugOptions, WithoutEffectAreRefused) {
    const auto refused = [&](const std::string& options, const std::string& words) {
        const ProgramResult result = run(options);
        EXPECT_EQ(result.exit_code, 2) << options;
        EXPECT_THAT(result.error, HasSubstr(words));
    };
    refused("--frame-length 0.1 --output x.png", "--frame-length");
    refused("--wireframe --explain-effects", "--wireframe: there is no --output");
    refused("--show tangent --explain-effects --output x.png", "--explain-effects");
    refused("--show tangent --exposure 1 --output x.png", "--exposure: does not apply to data");
    refused("--show diffuse --budget 5 --output x.png", "--budget");
    refused("--show tangents --output x.png", "not one of picture, geometric-normal");
    refused("--vertex-frames --frame-length 0 --output x.png", "--frame-length");
}

TEST(CommandLineOf, WritesTheChosenOptions) {
    DebugChoices choices;
    EXPECT_EQ(command_line_of(choices), "");
    choices.view = shade::DebugView::shading_normal;
    choices.wireframe = choices.vertex_frames = true;
    choices.frame_length = 0.05F;
    choices.grid = true;
    choices.health_markers = HealthChoice::all;
    EXPECT_EQ(command_line_of(choices),
              " --show shading-normal --wireframe --vertex-frames --frame-length 0.05 --grid "
              "--health-markers all");
}

}  // namespace
}  // namespace relief::tools
