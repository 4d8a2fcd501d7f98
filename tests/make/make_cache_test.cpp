// SPDX-License-Identifier: Apache-2.0
// Batches of `relief make` leave unchanged assets as they are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/workplace.h"

namespace relief::tools {
namespace {

using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

class MakeBatch : public testing::Test {
  protected:
    void SetUp() override {
        std::filesystem::create_directory(workplace / "in");
        for (const char* name : {"in/a.obj", "in/b.obj"})
            workplace.write_square(name);
        first = run();
        ASSERT_EQ(first.exit_code, 0) << first.error;
    }

    [[nodiscard]] ProgramResult run(const std::string& more = "") const {
        return workplace.run(
            "relief make in/a.obj in/b.obj -o out/ --size 32 "
            "--padding 2 --occlusion-rays 2" +
            more);
    }

    Workplace workplace;
    ProgramResult first;
};

TEST_F(MakeBatch, MakesOnlyWhatChanged) {
    EXPECT_THAT(first.out, Not(HasSubstr("unchanged")));
    const ProgramResult second = run();
    EXPECT_EQ(second.exit_code, 0);
    EXPECT_THAT(second.out, HasSubstr("out/a.glb: unchanged"));
    EXPECT_THAT(second.out, HasSubstr("out/b.glb: unchanged"));
    // An input.
    workplace.write("in/a.obj", workplace.read("in/a.obj") + "# changed\n");
    const ProgramResult third = run();
    EXPECT_THAT(third.out, Not(HasSubstr("out/a.glb: unchanged")));
    EXPECT_THAT(third.out, HasSubstr("out/b.glb: unchanged"));
    // An output.
    std::filesystem::remove(workplace / "out/b.glb");
    EXPECT_THAT(run().out, Not(HasSubstr("out/b.glb: unchanged")));
    EXPECT_TRUE(std::filesystem::exists(workplace / "out/b.glb"));
}

TEST_F(MakeBatch, MakesAllAfterAChangeOfOptionsAndByForce) {
    EXPECT_THAT(run(" --crease 30").out, Not(HasSubstr("unchanged")));
    EXPECT_THAT(run(" --crease 30").out, HasSubstr("unchanged"));
    EXPECT_THAT(run(" --crease 30 --force").out, Not(HasSubstr("unchanged")));
}

TEST_F(MakeBatch, IgnoresADamagedFile) {
    workplace.write("out/relief-make.json", "{");
    const ProgramResult result = run();
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, Not(HasSubstr("unchanged")));
    EXPECT_THAT(run().out, HasSubstr("unchanged"));
}

TEST(MakeCommand, ExplainsThePlanAndMakesNothing) {
    const Workplace workplace;
    const ProgramResult result =
        workplace.run("relief make data/urn-high.ply out/none/a.glb --explain --lods 2");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(workplace.outputs(), "");
    for (const char* text : {"decimate", "26800 triangles to 5000", "2 levels of detail", "about"})
        EXPECT_THAT(result.out, HasSubstr(text));
    const ProgramResult unnamed = workplace.run(
        "relief make data/urn-high.ply --explain --loss --view 0,90 --report out/plan.json");
    EXPECT_EQ(unnamed.exit_code, 0) << unnamed.error;
    EXPECT_THAT(unnamed.out, HasSubstr("data/urn-high.ply -> data/urn-high.glb"));
    EXPECT_EQ(workplace.outputs(), "plan.json");
    const nlohmann::json plan = nlohmann::json::parse(workplace.read("out/plan.json"))["plans"][0];
    std::string stages;
    for (const nlohmann::json& stage : plan["stages"]) {
        stages += stage["stage"].get<std::string>() + " ";
        EXPECT_LE(stage["milliseconds"], stage["processor_milliseconds"]);
    }
    EXPECT_EQ(stages, "read repair decimate unwrap remesh frames bake write verify loss ");
    EXPECT_EQ(plan["stages"][9]["text"], "13 views with 3 lights");
    const ProgramResult page =
        workplace.run("relief make data/urn-high.ply --explain --report out/plan.html");
    EXPECT_EQ(page.exit_code, 2);
    EXPECT_THAT(page.error, HasSubstr("--report out/plan.html: a plan cannot be a page"));
}

}  // namespace
}  // namespace relief::tools
