// SPDX-License-Identifier: Apache-2.0
// --effects, --benchmark, --budget and --print-shaders as users write them: what they draw, print
// and refuse. Of times, only what no noise can change is asserted.
#include "effect_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "relief/mesh/image_file.h"
#include "relief/shade/image_compare.h"
#include "support/invariants.h"
#include "tools/workplace.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

using nlohmann::json;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class EffectOptions : public testing::Test {
  protected:
    void SetUp() override { workplace_.write_square("square.obj"); }

    [[nodiscard]] ProgramResult run(const std::string& options) const {
        return workplace_.run("relief-view square.obj --camera 20,10 --size 33x33 --samples 1 " +
                              options);
    }

    [[nodiscard]] Image picture(const std::string& options) const {
        const ProgramResult result = run(options + " --output p.png --quiet");
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return read_image(workplace_ / "p.png", ImageUse::color);
    }

    [[nodiscard]] json summary(const std::string& options) const {
        const ProgramResult result = run(options + " --json");
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return json::parse(result.out);
    }

    Workplace workplace_;
};

TEST(ParseEffects, ReadsABaseAndNames) {
    EXPECT_EQ(parse_effects("--effects", "auto").base, EffectBase::planned);
    EXPECT_EQ(parse_effects("--effects", "all").base, EffectBase::all_neutral);
    const EffectRequest requests = parse_effects("--effects", "none,+diffuse,-normal map");
    EXPECT_EQ(requests.base, EffectBase::nothing);
    ASSERT_EQ(requests.forced.size(), 2U);
    EXPECT_EQ(requests.forced[0].name, "diffuse");
    EXPECT_TRUE(requests.forced[0].on);
    EXPECT_EQ(requests.forced[1].name, "normal map");
    EXPECT_FALSE(requests.forced[1].on);
    EXPECT_EQ(test::message_of<UsageError>([] { parse_effects("--effects", "+"); }),
              "--effects: '+' does not force an effect");
}

TEST_F(EffectOptions, SharedReasonsAreExplainedOnce) {
    std::string materials;
    std::string mesh = "mtllib many.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
    constexpr int count = 6;
    for (int i = 0; i < count; ++i) {
        const std::string name = "paint" + std::to_string(i);
        materials += "newmtl " + name + "\nKd 0.5 0.5 0.5\n" +
                     (i == 0   ? "Ks 1 1 1\nNs 20\n"
                      : i == 1 ? "Ke 1 0 0\n"
                               : "");
        mesh += "usemtl " + name + "\nf 1 2 3\n";
    }
    workplace_.write("many.mtl", materials);
    workplace_.write("many.obj", mesh);
    const ProgramResult result = workplace_.run("relief-view many.obj --explain-effects");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const auto times = [&](const std::string& text) {
        std::size_t found = 0;
        for (std::size_t at = result.out.find(text); at != std::string::npos;
             at = result.out.find(text, at + 1))
            ++found;
        return found;
    };
    // Three kinds of materials: shiny, glowing, and four that are alike.
    EXPECT_THAT(result.out, HasSubstr("draws     all 6\n"));
    EXPECT_EQ(times("\ndraw "), 3U);
    EXPECT_THAT(result.out, HasSubstr("(and 3 draws alike)"));
    EXPECT_EQ(times("environment tint"), 1U);
    EXPECT_EQ(times("the scene has no environment"), 2U) << "of the frame, and of all draws";
    EXPECT_EQ(times("on   diffuse"), 1U) << "on in all draws";
    EXPECT_EQ(times("on   emission"), 1U);
    EXPECT_EQ(times("material 'paint1' shines"), 1U);
    EXPECT_LE(std::count(result.out.begin(), result.out.end(), '\n'), 60);
}

TEST_F(EffectOptions, ForceNeutralEffectsWithoutAChangeAndTakeOutOthersWithOne) {
    const Image planned = picture("--shininess 8");
    EXPECT_EQ(compare(picture("--shininess 8 --effects all"), planned).max, 0.0);
    EXPECT_EQ(compare(picture("--shininess 8 --effects +normal-map,+point-lights"), planned).max,
              0.0);
    EXPECT_GT(compare(picture("--shininess 8 --effects -diffuse"), planned).max, 50.0);
    const json effects = summary("--effects +emission --explain-effects").at("effects");
    bool told = false;
    for (const json& effect : effects.at("draws").at(0).at("effects")) {
        if (effect.at("effect") != "emission") continue;
        told = true;
        EXPECT_EQ(effect.at("on"), true);
        EXPECT_EQ(effect.at("reason"), "forced on: the scene does not need it");
    }
    EXPECT_TRUE(told);
}

/// A relief of a hundredth of a texel moves nothing by half a pixel.
TEST_F(EffectOptions, HaveABoundOfReliefs) {
    workplace_.write_bricks("h.png");
    const auto relief_with = [&](const std::string& bound) -> std::pair<bool, std::string> {
        const json effects =
            summary("--height-map h.png --height-depth 0.01 --explain-effects" + bound)
                .at("effects");
        for (const json& effect : effects.at("draws").at(0).at("effects")) {
            if (effect.at("effect") == "maximum mipmaps")
                return {effect.at("on"), effect.at("reason")};
        }
        return {false, "not listed"};
    };
    EXPECT_FALSE(relief_with("").first);
    EXPECT_THAT(relief_with("").second, HasSubstr("pixels, less than 0.5"));
    EXPECT_THAT(relief_with(" --height-bound 0.25").second, HasSubstr("pixels, less than 0.25"));
    EXPECT_TRUE(relief_with(" --height-bound 0").first);
    EXPECT_THAT(relief_with(" --height-bound 0").second, Not(HasSubstr("less than")));
}

TEST_F(EffectOptions, RefuseUnknownAndImpossibleEffects) {
    EXPECT_EQ(run("--effects +emision --explain-effects").error,
              "relief-view: error: --effects: 'emision' is not an effect; did you mean 'emission'? "
              "(--explain-effects lists the effects and their reasons)\n");
    const ProgramResult flat = run("--effects +flat --explain-effects");
    EXPECT_EQ(flat.exit_code, 2);
    EXPECT_THAT(flat.error, HasSubstr("effect 'flat' cannot be forced on: material"));
    EXPECT_EQ(run("--effects diffuse --explain-effects").exit_code, 2);
    EXPECT_EQ(run("--benchmark 0").exit_code, 2);
    EXPECT_EQ(run("--budget 0").exit_code, 2);
}

TEST_F(EffectOptions, BenchmarkPrintsMedianAndSpreadAndNeedsNoOutput) {
    EXPECT_THAT(run("--benchmark 3").out, HasSubstr("benchmark 3 frames: "));
    const json benchmark = summary("--benchmark 3").at("benchmark");
    EXPECT_EQ(benchmark.at("frames"), 3);
    EXPECT_EQ(benchmark.at("programs"), 1);
    for (const char* part : {"frame_milliseconds", "draw_milliseconds", "read_back_milliseconds"}) {
        const json& spread = benchmark.at(part);
        EXPECT_GT(spread.at("p10"), 0.0) << part;
        EXPECT_LE(spread.at("p10"), spread.at("median")) << part;
        EXPECT_LE(spread.at("median"), spread.at("p90")) << part;
    }
    EXPECT_EQ(workplace_.outputs(), "");
}

TEST_F(EffectOptions, ExplainedWithABenchmarkArePriced) {
    const json summary_json = summary("--shininess 8 --benchmark 1 --explain-effects");
    const json& costs = summary_json.at("effect_costs").at("effects");
    bool found = false;
    for (const json& cost : costs) {
        if (cost.at("effect") != "diffuse") continue;
        found = true;
        EXPECT_GT(cost.at("change").at("max"), 50.0);
        EXPECT_GT(cost.at("change").at("flip_mean"), 0.0);
    }
    EXPECT_TRUE(found);
    EXPECT_THAT(run("--benchmark 1 --explain-effects").out, HasSubstr("costs     a frame takes "));
    EXPECT_FALSE(summary("--explain-effects").contains("effect_costs"));
}

TEST_F(EffectOptions, ReachableBudgetDropsNothingAndUnreachableFails) {
    EXPECT_THAT(run("--budget 100000").out, HasSubstr(": no effect is dropped"));
    EXPECT_TRUE(summary("--budget 100000").at("budget").at("dropped").empty());
    const ProgramResult impossible = run("--budget 0.001 --output p.png");
    EXPECT_EQ(impossible.exit_code, 1);
    EXPECT_THAT(impossible.error, StartsWith("relief-view: error: square.obj: a frame takes "));
    EXPECT_THAT(impossible.error, HasSubstr("and --budget allows 0.001: "));
    EXPECT_EQ(workplace_.outputs(), "") << "no picture";
}

TEST_F(EffectOptions, PrintedShadersAreTheOnesThatTheSceneCallsFor) {
    const ProgramResult result = run("--print-shaders");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, StartsWith("// Program 1 of 1: "));
    EXPECT_THAT(result.out, HasSubstr("uniform vec3 diffuse_color;"));
    EXPECT_THAT(result.out, Not(HasSubstr("specular_color")));
    const json shaders = summary("--print-shaders --shininess 8").at("shaders");
    ASSERT_EQ(shaders.size(), 1U);
    EXPECT_THAT(shaders.at(0).at("fragment"), HasSubstr("specular_color"));
    EXPECT_EQ(shaders.at(0).at("draws"), json::array({0}));
}

}  // namespace
}  // namespace relief::tools
