// SPDX-License-Identifier: Apache-2.0
// relief-bake pack, and the conventions of engines (--for).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engines.h"
#include "relief/mesh/image_file.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

template <typename Code>
Image image_of(int channels, const std::vector<Code>& codes) {
    Image image = make_image(static_cast<int>(codes.size()) / channels, 1, channels,
                             sizeof(Code) == 1 ? 8 : 16, ColorSpace::data);
    std::copy(codes.begin(), codes.end(), image.as<Code>().begin());
    return image;
}

class Pack : public testing::Test {
  protected:
    Pack() {
        write_image(place_ / "o.png", image_of<std::uint8_t>(1, {10, 20}));
        write_image(place_ / "r.png", image_of<std::uint16_t>(1, {65535, 257 * 30}));
        write_image(place_ / "mr.png", image_of<std::uint8_t>(3, {0, 40, 50, 0, 60, 70}));
    }

    /// Runs pack, and returns the codes of the written image.
    template <typename Code = std::uint8_t>
    std::vector<Code> packed(const std::string& words) {
        const ProgramResult result = place_.run("relief-bake pack out/p.png " + words);
        EXPECT_EQ(result.exit_code, 0) << result.error;
        out_ = result.out;
        const Image image = read_image(place_ / "out/p.png", ImageUse::data);
        return {image.as<Code>().begin(), image.as<Code>().end()};
    }

    const Workplace place_;
    std::string out_;
};

using Bytes = std::vector<std::uint8_t>;

TEST_F(Pack, OcclusionRoughnessAndMetalnessAreRedGreenAndBlue) {
    for (const std::string engine : {"", " --for gltf", " --for godot", " --for unreal"}) {
        EXPECT_EQ(packed("--occlusion o.png --roughness mr.png:g --metalness mr.png:b" + engine),
                  (Bytes{10, 40, 50, 20, 60, 70}));
    }
    EXPECT_THAT(out_, HasSubstr("channels  red: occlusion o.png\n"
                                "          green: roughness mr.png, g\n"
                                "          blue: metalness mr.png, b\n"));
}

TEST_F(Pack, UnitysMaskMapHasSmoothnessInAlpha) {
    EXPECT_EQ(packed("--occlusion o.png --roughness r.png --metalness mr.png:b --for unity"),
              (Bytes{50, 10, 0, 0, 70, 20, 0, 225}));
    EXPECT_EQ(packed("--occlusion o.png --smoothness r.png --for unity"),
              (Bytes{0, 10, 0, 255, 0, 20, 0, 30}));
}

TEST_F(Pack, MapsThatAreNotGivenAreConstant) {
    EXPECT_EQ(packed("--occlusion o.png"), (Bytes{10, 255, 0, 20, 255, 0}));
    EXPECT_EQ(packed("--metalness mr.png:b --roughness 0.4"), (Bytes{255, 102, 50, 255, 102, 70}));
    EXPECT_EQ(packed("--metalness mr.png:b --smoothness 0.4"), (Bytes{255, 153, 50, 255, 153, 70}));
}

TEST_F(Pack, KeepsSixteenBits) {
    using Samples = std::vector<std::uint16_t>;
    EXPECT_EQ(packed<std::uint16_t>("--occlusion o.png --roughness r.png --bits 16"),
              (Samples{2570, 65535, 0, 5140, 7710, 0}));
}

TEST_F(Pack, RefusesInputsThatDoNotFit) {
    write_image(place_ / "wide.png", image_of<std::uint8_t>(1, {1, 2, 3}));
    const std::string line = "relief-bake pack out/p.png ";
    expect_refusals(
        place_, "relief-bake", "p.png",
        {{"relief-bake pack out/p.png", 2, "no map"},
         {line + "--occlusion 0.5", 2, "no map"},
         {line + "--roughness r.png --smoothness r.png", 2,
          "--roughness, --smoothness: contradict each other"},
         {line + "--roughness 1.5 --occlusion o.png", 2, "--roughness 1.5: "},
         {line + "--roughness mr.png", 1, "mr.png: is not gray (name the channel: mr.png:g)"},
         {line + "--roughness mr.png:a", 1, "mr.png: has no channel a"},
         {line + "--roughness wide.png --occlusion o.png", 1,
          "wide.png: is 3 x 1, but o.png is 2 x 1"},
         {"relief-bake pack o.png --occlusion o.png", 2, "o.png: would replace its input"},
         {"relief-bake pack out/p.jpg --occlusion o.png", 2,
          "out/p.jpg: the format cannot store packed maps"}});
}

TEST(EngineRules, AreInTheOrderOfTheEngines) {
    for (const EngineRules& rules : engine_rules)
        EXPECT_EQ(&rules_of(rules.engine), &rules);
}

TEST(EngineRules, SetGreenAndBits) {
    const Workplace place;
    place.write_bricks("h.png");
    struct Case {
        const char* words;
        const char* green;
        int bits;
    };
    for (const Case& one : {Case{"--for unreal", "down", 8}, Case{"--for unity", "up", 8},
                            Case{"--for godot --bits 16", "up", 16}}) {
        SCOPED_TRACE(one.words);
        ASSERT_EQ(place
                      .run(std::string("relief-bake bump h.png out/n.png --kernel central3 "
                                       "--quiet ") +
                           one.words)
                      .exit_code,
                  0);
        const ImageInfo info = read_image_info(place / "out/n.png");
        EXPECT_EQ(info.bits, one.bits);
        EXPECT_EQ(info.metadata.at("relief:green"), one.green);
    }
    // Conversion for another engine inverts green.
    ASSERT_EQ(place.run("relief-bake convert out/n.png out/unreal.png --for unreal").exit_code, 0);
    EXPECT_EQ(read_image_info(place / "out/unreal.png").metadata.at("relief:green"), "down");
    const ProgramResult both =
        place.run("relief-bake convert out/n.png out/b.png --for unreal --green up");
    EXPECT_EQ(both.exit_code, 2);
    EXPECT_THAT(both.error, HasSubstr("--green up, --for unreal: contradict each other"));
}

}  // namespace
}  // namespace relief::tools
