// SPDX-License-Identifier: Apache-2.0
// The command `relief-accuracy run`: tables, files and errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/labels.h"
#include "support/sanitized.h"
#include "tools/schema_page.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

TEST_LABELS(slow, not_sanitized);
TEST(AccuracyRun, PrintsATableAndWritesTheReport) {
    const Workplace workplace;
    const ProgramResult result = workplace.run(
        "relief-accuracy run storage --quick --repeats 3 --passes 2 --output out/report");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.error, "");
    EXPECT_THAT(result.out, HasSubstr("storage/frames: Tangent frames in few bits\n"));
    EXPECT_THAT(result.out, HasSubstr("out/report/accuracy.json: "));
    const json report = json::parse(workplace.read("out/report/accuracy.json"));
    EXPECT_EQ(report["command"], "relief-accuracy run storage --quick --repeats 3 --passes 2");
    EXPECT_EQ(report["settings"]["passes"], 2);
    EXPECT_EQ(report["settings"]["repeats"], 3);
    const json& first = report["experiments"][0]["measurements"][0];
    EXPECT_EQ(first["cost"]["one_thread"]["rounds"].size(), 3U);
    EXPECT_GT(first["cost"]["one_thread"]["median"].get<double>(), 0.0);
    EXPECT_THAT(test::schema_faults(report, test::schema_rows("## accuracy.json"), false),
                testing::IsEmpty());
    EXPECT_THAT(workplace.read("out/report/accuracy.csv"),
                HasSubstr("\nstorage/frames,storage,\"float32, nearest\","
                          "encoding=float32; rounding=nearest,degrees,"));
}

TEST(AccuracyRun, ErrorsAloneAreTheSameEachTimeForAnyThreadsAndProcessor) {
    const Workplace workplace;
    const std::string line = "relief-accuracy run storage --quick --no-times --json";
    const ProgramResult first = workplace.run(line);
    ASSERT_EQ(first.exit_code, 0) << first.error;
    EXPECT_THAT(first.out, Not(HasSubstr("one_thread")));
    // glibc then chooses functions for processors without fused multiplication.
    const ProgramResult second =
        workplace.run("GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4 " + line);
    EXPECT_EQ(second.exit_code, 0) << second.error;
    EXPECT_EQ(second.out, first.out);
    if (test::is_sanitized) return;  // Sanitizers find no more in a third run.
    const json one = json::parse(workplace.run(line + " --threads 1").out);
    EXPECT_EQ(one["experiments"][0]["measurements"],
              json::parse(first.out)["experiments"][0]["measurements"]);
    EXPECT_EQ(workplace.outputs(), "") << "nothing is written unless asked for";
}

TEST(AccuracyRun, InterruptedWhileItMeasuresLeavesNoHalfReport) {
    const Workplace workplace;
    // The rounds take longer than the time to the signal, and the folder is created first.
    const ProgramResult result = test::run_program_until(
        {"relief-accuracy", "run", "storage", "--repeats", "1000", "--output", "out/report",
         "--quiet"},
        workplace / ".", [&] { return std::filesystem::exists(workplace / "out/report"); }, SIGINT);
    EXPECT_EQ(result.exit_code, 128 + SIGINT) << result.error;
    EXPECT_EQ(result.error, "");
    EXPECT_TRUE(std::filesystem::is_empty(workplace / "out/report"));
}

TEST(AccuracyRefusal, IsOneLine) {
    const Workplace workplace;
    workplace.write("taken", "a file");
    expect_refusals(
        workplace, "relief-accuracy", "old",
        {{"relief-accuracy run", 2, "SUBJECT is missing"},
         {"relief-accuracy run colour", 2, "colour: not one of all, "},
         {"relief-accuracy run storage all", 2, "all: includes the other subjects"},
         {"relief-accuracy run storage storage", 2, "storage: given twice"},
         {"relief-accuracy run storage --repeats 2", 2, "--repeats 2: not between 3 and 1000"},
         {"relief-accuracy run storage --repeats 5 --no-times", 2,
          "--no-times and --repeats contradict each other"},
         {"relief-accuracy run storage --json --quiet", 2,
          "--json and --quiet contradict each other"},
         {"relief-accuracy run storage --quiet", 2,
          "--quiet without --output would discard the results"},
         {"relief-accuracy run storage --output taken", 1, "taken: exists, but is not a folder"}});
}

}  // namespace
}  // namespace relief::tools
