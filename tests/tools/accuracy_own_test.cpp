// SPDX-License-Identifier: Apache-2.0
// relief-accuracy own as users run it: on meshes, maps and pairs, and what it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tools/refusal.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusal;
using test::ProgramResult;
using test::Refused;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

const json& measurement(const json& experiment, const std::string& method) {
    for (const json& one : experiment["measurements"]) {
        if (one["method"] == method) return one;
    }
    throw std::runtime_error("no method " + method);
}

TEST(AccuracyOwn, MeasuresAMeshAndSaysWhatToTake) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    const ProgramResult result =
        workplace.run("relief-accuracy own square.obj --no-times --truth surface");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("square.obj: a mesh"));
    EXPECT_THAT(result.out, HasSubstr("own/square.obj/normals"));
    EXPECT_THAT(result.out, HasSubstr("no recommendation: the mesh is too coarse"));
    EXPECT_THAT(result.out, HasSubstr("To do it: relief-mesh process square.obj"));
    EXPECT_EQ(workplace.outputs(), "") << "nothing is written unless asked for";
}

TEST(AccuracyOwn, JsonHoldsTheCommandThatRepeatsIt) {
    const Workplace workplace;
    workplace.write_square("a square.obj");
    const ProgramResult result = workplace.run(
        "relief-accuracy own 'a square.obj' --no-times --crease 30 --max-error 5 --json");
    const json report = json::parse(result.out);
    EXPECT_EQ(report["command"],
              "relief-accuracy own 'a square.obj' --crease 30 --max-error 5 --no-times");
    EXPECT_EQ(report["experiments"][0]["command"], report["command"]);
    EXPECT_EQ(report["experiments"][1]["id"], "own/a square.obj/tangents");
    EXPECT_NEAR(measurement(report["experiments"][1], "mikktspace")["error"]["max"].get<double>(),
                0.0, 1e-4);
}

TEST(AccuracyOwn, TellsHeightsFromNormalsAndSaysSo) {
    const Workplace workplace;
    const ProgramResult heights =
        workplace.run("relief-accuracy own data/bricks-height.png --quick --no-times --strength 4");
    ASSERT_EQ(heights.exit_code, 0) << heights.error;
    EXPECT_THAT(heights.out, HasSubstr("data/bricks-height.png: a height map of "));
    EXPECT_THAT(heights.out, HasSubstr("(else: --image normals)"));
    EXPECT_THAT(heights.out, HasSubstr("To do it: relief-bake bump data/bricks-height.png OUT."));
    ASSERT_EQ(workplace.run("relief-bake bump data/bricks-height.png out/normals.png --strength 4")
                  .exit_code,
              0);
    const ProgramResult normals =
        workplace.run("relief-accuracy own out/normals.png --quick --no-times");
    EXPECT_THAT(normals.out, HasSubstr("out/normals.png: a normal map of 16 bits"));
    EXPECT_THAT(normals.out, HasSubstr("(else: --image heights)"));
    const ProgramResult told =
        workplace.run("relief-accuracy own out/normals.png --quick --no-times --image heights");
    EXPECT_THAT(told.out, HasSubstr("a height map of 16 bits"));
    EXPECT_THAT(told.out, Not(HasSubstr("else:")));
}

TEST(AccuracyOwn, TakesAPairOnlyWhereItIsCalledOne) {
    const Workplace workplace;
    workplace.write_square("high.obj");
    workplace.write_square("low.obj");
    const ProgramResult pair = workplace.run(
        "relief-accuracy own --high high.obj --low low.obj --size 16 --no-times --json");
    ASSERT_EQ(pair.exit_code, 0) << pair.error;
    const json report = json::parse(pair.out);
    EXPECT_EQ(report["experiments"].size(), 1U);
    EXPECT_EQ(report["experiments"][0]["subject"], "bake");
    EXPECT_LE(
        measurement(report["experiments"][0], "1 sample, 16 bit")["error"]["max"].get<double>(),
        0.01);
    const ProgramResult two =
        workplace.run("relief-accuracy own high.obj low.obj --no-times --json");
    EXPECT_EQ(json::parse(two.out)["experiments"].size(), 8U);
}

TEST(AccuracyOwn, ABoundThatNothingKeepsIsExitOne) {
    const Workplace workplace;
    const std::string line =
        "relief-accuracy own data/bricks-height.png --quick --no-times --max-error ";
    EXPECT_EQ(workplace.run(line + "90").exit_code, 0);
    const ProgramResult strict = workplace.run(line + "0");
    EXPECT_EQ(strict.exit_code, 1);
    EXPECT_THAT(strict.out, HasSubstr("none keeps within 0 degrees: the least is "));
}

class OwnRefusal : public testing::TestWithParam<Refused> {};

TEST_P(OwnRefusal, IsOneLine) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    workplace.write("other.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    expect_refusal(workplace, "relief-accuracy", GetParam(), "old");
}

INSTANTIATE_TEST_SUITE_P(
    All, OwnRefusal,
    testing::Values(Refused{"relief-accuracy own", 2,
                            "nothing to measure on (name a mesh, a map, or --high and "
                            "--low)"},
                    Refused{"relief-accuracy own --high square.obj", 2,
                            "--high: needs the other mesh of the pair (give --low FILE)"},
                    Refused{"relief-accuracy own square.obj square.obj", 2,
                            "square.obj: given twice"},
                    Refused{"relief-accuracy own square.obj --strength 3", 2,
                            "--strength: is for height maps, and there is none"},
                    Refused{"relief-accuracy own square.obj --size 64", 2,
                            "--size: is for a pair, --high and --low, and there is none"},
                    Refused{"relief-accuracy own square.obj --max-error-kind max", 2,
                            "--max-error-kind: is for --max-error (give --max-error DEG)"},
                    Refused{"relief-accuracy own square.obj --no-times --max-time 3", 2,
                            "--no-times and --max-time contradict each other"},
                    Refused{"relief-accuracy own other.obj --truth file --no-times", 1,
                            "other.obj: the mesh has no normals to compare with"},
                    Refused{"relief-accuracy own --high square.obj --low other.obj --no-times", 1,
                            "other.obj: no texture coordinates for a map to lie on"}));

}  // namespace
}  // namespace relief::tools
