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

std::string text_of(const std::filesystem::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

class RunTests : public testing::Test {
  protected:
    void SetUp() override {
        std::filesystem::create_directories(build_ / "tests");
        describe(300);
    }

    /// Writes the description that CMake writes, with a time limit for each case.
    void describe(int case_seconds, bool sanitized = false) const {
        std::ofstream(build_ / "tests/test-programs.json") << fmt::format(
            R"({{"sources": "{}", "sanitized": {}, "case_seconds": {},
                 "environment": {{"RUN_TESTS_SAMPLE_MARK": "{}"}},
                 "programs": [{{"name": "sample", "path": "{}", "label": "unit"}}]}})",
            sources_.string(), sanitized, case_seconds, (build_ / "mark").string(),
            RELIEF_RUN_TESTS_SAMPLE);
    }

    /// Lists the cases after a change of the sample's source. Returns the errors.
    [[nodiscard]] std::string errors_after(const std::string& text, const std::string& other) {
        std::string source = text_of(sources_ / sample);
        source.replace(source.find(text), text.size(), other);
        sources_ = build_.path();
        std::filesystem::create_directories((sources_ / sample).parent_path());
        std::ofstream(sources_ / sample) << source;
        describe(300);
        return run("--list").error;
    }

    [[nodiscard]] ProgramResult run(const std::string& options, const std::string& ci = "") const {
        return run_shell(
            fmt::format("CI={} '{}' . {}", ci,
                        (source_directory() / "scripts/dev/run-tests").string(), options),
            build_.path());
    }

    [[nodiscard]] std::string results() const { return text_of(build_ / "test-results.xml"); }

  private:
    static constexpr const char* sample = "tests/docs/run_tests_sample.cpp";

    TemporaryDirectory build_;
    std::filesystem::path sources_ = source_directory();
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

TEST_F(RunTests, RefusesSourcesThatAreNewerThanTheProgram) {
    EXPECT_THAT(errors_after("TEST(Measured, Memory)", "TEST(Measured, Time)"),
                HasSubstr(" is not Measured.Memory (build the tests again)"));
}

TEST_F(RunTests, RefusesLabelsOfParametersThatNoCaseHas) {
    EXPECT_EQ(errors_after("\"Large/", "\"Huge/"),
              "run-tests: error: tests/docs/run_tests_sample.cpp: no case fits "
              "TEST_LABELS_OF(\"Huge/*\")\n");
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
    EXPECT_EQ(run("-L slow -E Sweep --list").out,
              "sample/SlowOnes.Slow unit slow\n"
              "sample/Large/Parameter.IsNotNegative/0 unit slow\n");
    EXPECT_THAT(run("--list").out, HasSubstr("sample/Small/Parameter.IsNotNegative/0 unit\n"));
    EXPECT_THAT(run("--all --list").out, HasSubstr("sample/SlowOnes.Slow unit slow\n"));
    EXPECT_THAT(run("--list").out, HasSubstr("sample/Measured.Memory unit\n"));
    describe(300, true);
    EXPECT_THAT(run("--list").out, Not(HasSubstr("Measured.Memory")));
    EXPECT_EQ(run("-L nothing").exit_code, 2);
    EXPECT_EQ(run("-R NoSuchCase").exit_code, 1);
}

TEST_F(RunTests, RunsAPartOfEachSweepInTurn) {
    const auto rest_of = [](int count) {
        return fmt::format(
            "run-tests: note: left out {} cases of sweeps, which --sweeps with other "
            "numbers runs\n",
            count);
    };
    const auto line = [](int number) {
        return fmt::format("sample/Of/Sweep.IsNotNegative/{} unit slow\n", number);
    };
    EXPECT_EQ(run("--all -R Sweep --list").out, line(0) + line(1) + line(2) + line(3) + line(4));
    EXPECT_EQ(run("--all -R Sweep --list --sweeps 8/3").out, rest_of(4) + line(2));
    EXPECT_EQ(run("--all -R Sweep --list --sweeps 9/3").out, rest_of(3) + line(0) + line(3));
    EXPECT_EQ(run("--all -R Sweep --list --sweeps 10/3").out, rest_of(3) + line(1) + line(4));
    EXPECT_THAT(run("--all --list --sweeps 10/3").out, HasSubstr("sample/SlowOnes.Slow"));
    EXPECT_EQ(run("--sweeps 1/0").exit_code, 2);
}

}  // namespace
}  // namespace relief::test
