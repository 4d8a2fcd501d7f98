// SPDX-License-Identifier: Apache-2.0
// The command `relief-accuracy compare` on invented reports.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include <nlohmann/json.hpp>

#include "accuracy_report.h"
#include "tools/report_sample.h"
#include "tools/schema_page.h"
#include "tools/workplace.h"

namespace relief::tools {
using namespace relief::accuracy;

namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::sample_report;
using test::Workplace;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Returns a report of 12 methods with 9 rounds each.
AccuracyReport steady_report() {
    AccuracyReport report = sample_report();
    Experiment& one = report.experiments[0];
    const Measurement sample = one.measurements[1];
    one.measurements.clear();
    for (int i = 0; i < 12; ++i) {
        Measurement measurement = sample;
        measurement.method = "method " + std::to_string(i);
        measurement.cost.all_threads.reset();
        measurement.cost.one_thread->rounds.clear();
        for (const double part : {1.0, 1.01, 0.99, 1.005, 0.995, 1.002, 0.998, 1.001, 0.999})
            measurement.cost.one_thread->rounds.push_back(part * 1e-3 * (i + 1));
        one.measurements.push_back(measurement);
    }
    return report;
}

void slow_down(AccuracyReport& report, std::size_t method, double factor) {
    for (double& seconds : report.experiments[0].measurements[method].cost.one_thread->rounds)
        seconds *= factor;
}

ProgramResult compared(const Workplace& workplace, const AccuracyReport& before,
                       const AccuracyReport& after, const std::string& options = "") {
    workplace.write("old.json", json_of(before, true).dump());
    workplace.write("new.json", json_of(after, true).dump());
    return workplace.run("relief-accuracy compare old.json new.json " + options);
}

TEST(AccuracyCompare, EqualReportsHaveNoChange) {
    const Workplace workplace;
    const ProgramResult result = compared(workplace, steady_report(), steady_report(),
                                          "--max-slower 10 --max-error-growth 0");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.error, "");
    EXPECT_THAT(result.out, HasSubstr("methods   12 in both\n"));
    EXPECT_THAT(result.out, HasSubstr("times     all: 1.00 times as long on one thread (1.00 to "
                                      "1.00, 12 methods): tie\n"));
    EXPECT_THAT(result.out, HasSubstr("errors    all the same\n"));
    for (const char* word : {"slower", "faster", "missing", "added", "machine"})
        EXPECT_THAT(result.out, Not(HasSubstr(word)));
}

TEST(AccuracyCompare, ReportsSlowerMethodsAndChecksTheirLimit) {
    const Workplace workplace;
    AccuracyReport after = steady_report();
    for (std::size_t i = 0; i < 12; ++i)
        slow_down(after, i, i < 2 ? 9.0 : i < 11 ? 1.3 : 0.5);
    const ProgramResult within = compared(workplace, steady_report(), after, "--max-slower 30");
    EXPECT_EQ(within.exit_code, 0) << within.error;
    EXPECT_THAT(within.out, HasSubstr("times     all: 1.30 times as long on one thread (1.30 to "
                                      "1.30, 12 methods): slower\n"));
    const ProgramResult beyond =
        compared(workplace, steady_report(), after, "--max-slower 29 --quiet");
    EXPECT_EQ(beyond.exit_code, 1);
    EXPECT_EQ(beyond.out, "");
    EXPECT_EQ(beyond.error,
              "relief-accuracy: error: new.json: all: 1.30 times as long on one thread (1.30 to "
              "1.30, 12 methods): slower (at most 29 % more)\n");
    EXPECT_THAT(compared(workplace, after, steady_report()).out, HasSubstr(": faster\n"));
}

TEST(AccuracyCompare, OtherMachinesAreNotJudged) {
    const Workplace workplace;
    AccuracyReport other_machine = steady_report();
    other_machine.machine.processor = "Another processor";
    AccuracyReport other_threads = steady_report();
    other_threads.settings.threads = 1;
    for (const auto& [after, difference] :
         {std::pair(other_machine, "processor: A processor, then Another processor"),
          std::pair(other_threads, "threads: 2, then 1")}) {
        const ProgramResult shown = compared(workplace, steady_report(), after);
        EXPECT_EQ(shown.exit_code, 0) << shown.error;
        EXPECT_THAT(shown.out, HasSubstr(fmt::format("machine   {}\n          the times contain "
                                                     "this difference\n",
                                                     difference)));
        const ProgramResult judged = compared(workplace, steady_report(), after, "--max-slower 20");
        EXPECT_EQ(judged.exit_code, 1);
        EXPECT_EQ(judged.error,
                  fmt::format("relief-accuracy: error: new.json: was measured on another machine "
                              "than old.json ({}), so --max-slower cannot be checked (run both on "
                              "the same machine)\n",
                              difference));
    }
}

TEST(AccuracyCompare, TimesOnAllThreadsAreNotJudged) {
    const Workplace workplace;
    AccuracyReport before = steady_report();
    AccuracyReport after = before;
    for (std::size_t i = 0; i < 12; ++i) {
        before.experiments[0].measurements[i].cost.all_threads = Timing{{1.0}};
        after.experiments[0].measurements[i].cost.all_threads = Timing{{5.0}};
    }
    const ProgramResult result = compared(workplace, before, after, "--max-slower 20");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("all: 5.00 times as long on all threads (5.00 to 5.00, 12 "
                                      "methods): not judged\n"));
}

TEST(AccuracyCompare, AnotherRendererMayDrawOtherBits) {
    const Workplace workplace;
    AccuracyReport after = steady_report();
    after.machine.opengl = "Another renderer";
    const ProgramResult result = compared(workplace, steady_report(), after);
    EXPECT_THAT(result.out, HasSubstr("OpenGL: A renderer, then Another renderer\n"));
    EXPECT_THAT(result.out, HasSubstr("pictures drawn by OpenGL may differ slightly"));
}

TEST(AccuracyCompare, MemoryThatHardlyDiffersIsTheSameMachine) {
    const Workplace workplace;
    AccuracyReport after = steady_report();
    after.machine.memory_bytes = after.machine.memory_bytes * 101 / 100;
    EXPECT_THAT(compared(workplace, steady_report(), after).out, Not(HasSubstr("machine")));
    after.machine.memory_bytes *= 2;
    EXPECT_THAT(compared(workplace, steady_report(), after).out,
                HasSubstr("machine   memory: 1.0 MB, then 2.0 MB\n"));
}

TEST(AccuracyCompare, ReportsMemoryAndChecksItsLimit) {
    const Workplace workplace;
    AccuracyReport before = steady_report();
    before.experiments[0].measurements[2].cost.peak_bytes = 20'000'000;
    before.experiments[0].measurements[5].cost.peak_bytes = 20'000'000;
    AccuracyReport after = before;
    after.experiments[0].measurements[2].cost.peak_bytes = 30'000'000;
    after.experiments[0].measurements[5].cost.peak_bytes =
        21'900'000;  // The change is less than 10 %.
    after.experiments[0].measurements[7].cost.peak_bytes =
        900'000;  // The change is less than a megabyte.
    const ProgramResult same = compared(workplace, before, before, "--max-memory-growth 0");
    EXPECT_EQ(same.exit_code, 0) << same.error;
    EXPECT_THAT(same.out,
                HasSubstr("memory    unchanged within 10 % or one megabyte, for 12 methods\n"));
    const ProgramResult within = compared(workplace, before, after, "--max-memory-growth 50");
    EXPECT_EQ(within.exit_code, 0) << within.error;
    EXPECT_THAT(within.out,
                HasSubstr("more      storage/sample: method 2: memory 20 MB then 30 MB\n"));
    const ProgramResult beyond = compared(workplace, before, after, "--max-memory-growth 49");
    EXPECT_EQ(beyond.exit_code, 1);
    EXPECT_EQ(
        beyond.error,
        "relief-accuracy: error: new.json: storage/sample: method 2: memory 20 MB then 30 MB (at "
        "most 49 % more)\n");
    EXPECT_THAT(compared(workplace, after, before).out,
                HasSubstr("less      storage/sample: method 2: memory 30 MB then 20 MB\n"));
    for (Measurement& one : before.experiments[0].measurements)
        one.cost.peak_bytes.reset();
    const ProgramResult unknown = compared(workplace, before, after, "--max-memory-growth 49");
    EXPECT_EQ(unknown.exit_code, 1);
    EXPECT_THAT(unknown.error, HasSubstr("so --max-memory-growth cannot be checked"));
}

TEST(AccuracyCompare, MissingMethodsExceedLimits) {
    const Workplace workplace;
    AccuracyReport after = steady_report();
    after.experiments[0].measurements.pop_back();
    after.experiments[0].charts[0].curves[0].points.pop_back();
    const ProgramResult told = compared(workplace, steady_report(), after);
    EXPECT_EQ(told.exit_code, 0) << told.error;
    EXPECT_THAT(told.out, HasSubstr("missing   storage/sample: method 11\n"
                                    "          storage/sample, chart scale: near at 1\n"));
    for (const char* bound : {"--max-slower 50", "--max-error-growth 50"}) {
        const ProgramResult bounded = compared(workplace, steady_report(), after, bound);
        EXPECT_EQ(bounded.exit_code, 1);
        EXPECT_EQ(bounded.error,
                  "relief-accuracy: error: new.json: storage/sample: method 11: is missing, and 1 "
                  "more above limits\n");
    }
}

TEST(AccuracyCompare, ErrorsThatGrewAreHeldAgainstTheirBound) {
    const Workplace workplace;
    AccuracyReport after = steady_report();
    after.experiments[0].measurements[0].error.rms *= 1.02;
    after.experiments[0].measurements[1].error.max *= 0.5;
    const ProgramResult within =
        compared(workplace, steady_report(), after, "--max-error-growth 3");
    EXPECT_EQ(within.exit_code, 0) << within.error;
    EXPECT_THAT(within.out, HasSubstr("worse     storage/sample: method 0: rms 0.25 then 0.255\n"));
    EXPECT_THAT(within.out, HasSubstr("better    storage/sample: method 1: max 0.75 then 0.375\n"));
    after.experiments[0].charts[0].curves[0].points[2].error =
        std::numeric_limits<double>::quiet_NaN();
    const ProgramResult beyond =
        compared(workplace, steady_report(), after, "--max-error-growth 1");
    EXPECT_EQ(beyond.exit_code, 1);
    EXPECT_EQ(beyond.error,
              "relief-accuracy: error: new.json: storage/sample, chart scale: near: at 1 0.25 then "
              "no result (at most 1 % more), and 1 more above limits\n");
}

TEST(AccuracyCompare, JsonMatchesItsDocument) {
    const Workplace workplace;
    AccuracyReport before = steady_report();
    AccuracyReport after = steady_report();
    for (std::size_t i = 0; i < 12; ++i)
        slow_down(after, i, 1.2);
    after.experiments[0].measurements[0].error.rms = 1.0;
    after.experiments[0].measurements[5].method = "new";
    after.experiments[0].measurements[6].cost.peak_bytes = 50'000'000;
    Experiment other = before.experiments[0];
    other.id = "storage/other";
    before.experiments.push_back(other);
    other.input = "something";
    after.experiments.push_back(other);
    const ProgramResult result =
        compared(workplace, before, after, "--json --max-slower 10 --max-error-growth 10");
    EXPECT_EQ(result.exit_code, 1);
    const json found = json::parse(result.out);
    const std::vector<test::SchemaRow> rows = test::schema_rows("## compare --json");
    EXPECT_THAT(test::schema_faults(found, rows, true), IsEmpty());
    EXPECT_EQ(found["beyond"].size(), 3U);  // The times, an error, and a missing method.
    EXPECT_EQ(found["times"][0]["verdict"], "slower");
    EXPECT_NEAR(found["times"][0]["ratio"].get<double>(), 1.2, 1e-6);
    EXPECT_EQ(found["memory"][0]["figures"][0]["after"], 50e6);
    EXPECT_EQ(found["errors"][0]["figures"][0]["growth"], 3.0);
}

TEST(AccuracyCompareRefusal, IsOneLine) {
    const Workplace workplace;
    workplace.write("report.json", json_of(steady_report(), true).dump());
    AccuracyReport other = steady_report();
    other.experiments[0].input = "something else";
    workplace.write("other.json", json_of(other, true).dump());
    AccuracyReport untimed = steady_report();
    for (Measurement& one : untimed.experiments[0].measurements)
        one.cost = {};
    workplace.write("untimed.json", json_of(untimed, true).dump());
    workplace.write("text.json", "hello");
    expect_refusals(
        workplace, "relief-accuracy", "old",
        {{"relief-accuracy compare report.json", 2, "NEW is missing"},
         {"relief-accuracy compare report.json none.json", 1, "none.json: "},
         {"relief-accuracy compare report.json text.json", 1,
          "text.json: is not JSON (relief-accuracy run SUBJECT --output DIR writes "
          "DIR/accuracy.json)"},
         {"relief-accuracy compare report.json other.json", 1,
          "other.json: has no method on the same input as report.json (run the same "
          "subjects, both with --quick or both without)"},
         {"relief-accuracy compare untimed.json report.json --max-slower 5", 1,
          "report.json: has times of fewer than 6 methods in common with untimed.json, so "
          "--max-slower cannot be checked (run more subjects, both without "
          "--no-times)"},
         {"relief-accuracy compare report.json report.json --max-slower -1", 2,
          "--max-slower -1: "},
         {"relief-accuracy compare report.json report.json --json --quiet", 2,
          "--json and --quiet contradict each other"}});
}

}  // namespace
}  // namespace relief::tools
