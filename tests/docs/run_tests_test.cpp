// SPDX-License-Identifier: Apache-2.0
// scripts/dev/run-tests with cases that fail, crash, do not end, or pass in a second run.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "support/shared_data.h"
#include "tools/linked_tools.h"

namespace relief::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class RunTests : public testing::Test {
  protected:
    void SetUp() override {
        std::filesystem::create_directories(build_ / "tests");
        describe(300);
    }

    /// Writes the description that CMake writes, with a time limit for each case.
    void describe(int case_seconds) const {
        std::ofstream(build_ / "tests/test-programs.json") << fmt::format(
            R"({{"case_seconds": {}, "environment": {{"RUN_TESTS_SAMPLE_MARK": "{}"}},
                 "programs": [{{"name": "sample", "path": "{}", "label": "unit",
                                "patterns": {{"slow": ["SlowOnes.*"], "alone": ["SharedFixture.First"],
                                              "gl": ["Crash.*", "Renamed.*"]}}}}]}})",
            case_seconds, (build_ / "mark").string(), RELIEF_RUN_TESTS_SAMPLE);
    }

    [[nodiscard]] ProgramResult run(const std::string& options, const std::string& ci = "") const {
        return run_shell(
            fmt::format("CI={} '{}' . {}", ci,
                        (source_directory() / "scripts/dev/run-tests").string(), options),
            build_.path());
    }

    [[nodiscard]] std::string results() const {
        std::ifstream file(build_ / "test-results.xml");
        return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    }

  private:
    TemporaryDirectory build_;
};

std::string last_line(const ProgramResult& result) {
    const std::string text = result.out.substr(0, result.out.find_last_not_of('\n') + 1);
    return text.substr(text.rfind('\n') + 1);
}

TEST_F(RunTests, CountsCasesAndKeepsResults) {
    const ProgramResult result = run("-R 'Sample\\.|SharedFixture'");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(last_line(result), "3 passed, 1 failed, 1 skipped");
    EXPECT_THAT(result.out, HasSubstr("---- FAILED sample/Sample.Fails\n"));
    EXPECT_THAT(result.out, HasSubstr("the reason"));
    EXPECT_THAT(result.out, HasSubstr("5 test cases in 2 shards"));
    EXPECT_THAT(results(),
                HasSubstr(R"(<testsuite name="sample" tests="5" failures="1" skipped="1")"));
    EXPECT_THAT(results(), HasSubstr("the reason"));
}

TEST_F(RunTests, WarnsOfPatternsThatNoCaseFits) {
    EXPECT_EQ(run("--list").error, "run-tests: warning: sample: no case fits GL Renamed.*\n");
}

TEST_F(RunTests, ReportsTheCaseThatCrashedAndRunsTheOthers) {
    const ProgramResult result = run("-R Crash");
    EXPECT_EQ(last_line(result), "2 passed, 1 failed, 0 skipped");
    EXPECT_THAT(result.out, HasSubstr("sample/Crash.Crashes ended the program by signal SIGABRT"));
}

TEST_F(RunTests, ReportsTheCaseThatLeftTheProgram) {
    const ProgramResult result = run("-R Exit");
    EXPECT_EQ(last_line(result), "1 passed, 1 failed, 0 skipped");
    EXPECT_THAT(result.out,
                HasSubstr("sample/Exit.LeavesTheProgram ended the program with exit status 0"));
}

TEST_F(RunTests, EndsACaseAtItsTimeLimit) {
    describe(4);
    const ProgramResult result = run("-R Endless");
    EXPECT_EQ(last_line(result), "1 passed, 1 failed, 0 skipped");
    EXPECT_THAT(result.out, HasSubstr("sample/Endless.DoesNotEnd exceeded the limit of 4 seconds"));
}

TEST_F(RunTests, ACaseThatPassesWhenItRunsAgainIsFlakyAndFailsInCiOnly) {
    const ProgramResult result = run("-R Flaky");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(last_line(result), "1 passed, 0 failed, 0 skipped");
    EXPECT_THAT(result.out, HasSubstr("---- FLAKY sample/Flaky.FailsOnce"));
    EXPECT_THAT(results(), HasSubstr("flakyFailure"));
}

TEST_F(RunTests, AFlakyCaseFailsInCi) {
    const ProgramResult result = run("-R Flaky", "true");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(last_line(result), "0 passed, 1 failed, 0 skipped");
}

TEST_F(RunTests, ACaseThatChangesTheProcessFails) {
    const ProgramResult result = run("-R Environment");
    EXPECT_EQ(last_line(result), "0 passed, 1 failed, 0 skipped");
    EXPECT_THAT(result.out,
                HasSubstr("added the environment variable RUN_TESTS_SAMPLE_LEFT_BEHIND"));
}

TEST_F(RunTests, SelectsByLabelAndLeavesSlowCasesOut) {
    const std::string gl = run("-L gl --list").out;
    EXPECT_THAT(gl, HasSubstr("sample/Crash.Before gl\n"));
    EXPECT_THAT(gl, Not(HasSubstr("Sample.Passes")));
    EXPECT_THAT(run("--list").out, Not(HasSubstr("SlowOnes")));
    EXPECT_EQ(run("-L slow --list").out, "sample/SlowOnes.Slow unit slow\n");
    EXPECT_THAT(run("--all --list").out, HasSubstr("sample/SlowOnes.Slow unit slow\n"));
    EXPECT_EQ(run("-L nothing").exit_code, 2);
    EXPECT_EQ(run("-R NoSuchCase").exit_code, 1);
}

}  // namespace
}  // namespace relief::test
