// SPDX-License-Identifier: Apache-2.0
// The command `relief-accuracy fidelity` on small models in small pictures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <nlohmann/json.hpp>

#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::Workplace;
using testing::AllOf;
using testing::HasSubstr;

constexpr const char* small = " --size 32 --views 2 --samples 1 --threads 1";

TEST(FidelityCommand, MeasuresAChainAgainstItsSource) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    // Half of the square.
    workplace.write("half.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nf 1 2 3\n");
    const ProgramResult result = workplace.run(
        std::string("relief-accuracy fidelity square.obj square.obj half.obj "
                    "--report out/loss.json --pictures out/loss --view 0,0 --view 90,0") +
        small);
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, AllOf(HasSubstr("source    square.obj: 2 triangles, 2.828 across"),
                                  HasSubstr("after     square.obj: 2 triangles"),
                                  HasSubstr("after     half.obj: 1 triangle"),
                                  HasSubstr("noise floor (mean)")));
    const json report = json::parse(workplace.read("out/loss.json"));
    ASSERT_EQ(report["stages"].size(), 2U);
    const json& equal = report["stages"][0];
    EXPECT_EQ(equal["pictures"]["studio"]["mean"], 0.0);
    EXPECT_EQ(equal["normals"]["max"], 0.0);
    EXPECT_EQ(equal["silhouettes"]["width"], 0.0);
    EXPECT_EQ(equal["distance_from_source"]["max"], 0.0);
    const json& half = report["stages"][1];
    EXPECT_GT(half["pictures"]["studio"]["mean"], 0.1);
    EXPECT_GT(half["silhouettes"]["width"], 1.0);
    EXPECT_GT(half["distance_from_source"]["max"], 1.0);
    // The part that is farther than d is (1 - d / sqrt(2))^2 / 2.
    EXPECT_NEAR(half["distance_from_source"]["p95"].get<double>(),
                std::sqrt(2.0) * (1.0 - std::sqrt(0.1)), 0.02);
    // The views on request follow the two others. One shows the square from its front, where half
    // of it is missing, and one from its edge, where nothing is seen.
    ASSERT_EQ(half["views"].size(), 4U);
    const auto numbered = [&](std::size_t number) {
        return *std::ranges::find_if(half["views"],
                                     [&](const json& one) { return one["view"] == number; });
    };
    EXPECT_EQ(numbered(2)["from"], json({0.0, 0.0, 1.0}));
    EXPECT_GT(numbered(2)["silhouette_pixels"], 1.0);
    EXPECT_NEAR(numbered(3)["from"][0].get<double>(), 1.0, 1e-6);
    EXPECT_LT(numbered(3)["silhouette_pixels"], numbered(2)["silhouette_pixels"]);
    EXPECT_EQ(half["distance_to_source"]["max"], 0.0);
    const auto largest = [&](std::size_t view) {
        const json& flip = half["views"][view]["flip"];
        return std::max({flip[0].get<double>(), flip[1].get<double>(), flip[2].get<double>()});
    };
    EXPECT_GE(largest(0), largest(1));
    EXPECT_TRUE(exists(workplace / "out/loss/2-half-studio.png"));
    EXPECT_TRUE(exists(workplace / "out/loss/1-square-base-color.png"));
}

TEST(FidelityCommand, ChecksLimitsOfTheLastResult) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    workplace.write("half.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nf 1 2 3\n");
    const std::string line = "relief-accuracy fidelity square.obj half.obj square.obj --quiet";
    EXPECT_EQ(workplace.run(line + " --max-error 0 --max-picture-error 0" + small).exit_code, 0);
    const ProgramResult beyond = workplace.run(
        "relief-accuracy fidelity square.obj half.obj --quiet --max-picture-error 0.01" +
        std::string(small));
    EXPECT_EQ(beyond.exit_code, 1);
    EXPECT_EQ(beyond.out, "");
    EXPECT_THAT(beyond.error,
                AllOf(HasSubstr("relief-accuracy: error: half.obj: pictures differ by "),
                      HasSubstr(" (mean FLIP), and --max-picture-error allows 0.01\n")));
}

TEST(FidelityCommand, RefusesWrongUse) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    workplace.write("empty.obj", "v 0 0 0\n");
    const std::string line = "fidelity square.obj ";
    expect_refusals(
        workplace, "relief-accuracy", "old",
        {{"fidelity square.obj", 2, "no RESULT (name the models to compare"},
         {line + "square.obj --size 8", 2, "--size 8: not between 16 and 4096"},
         {line + "square.obj --samples 2", 2, "--samples 2: not one of 1, 4, 9, 16"},
         {line + "square.obj --view 30", 2, "--view 30: not azimuth,elevation"},
         {line + "square.obj --view 30,91", 2, "--view 30,91: 91: not between -90 and 90 degrees"},
         {line + "square.obj --report square.obj", 2, "--report square.obj: "},
         {line + "missing.obj", 1, "missing.obj: "}});
}

}  // namespace
}  // namespace relief::tools
