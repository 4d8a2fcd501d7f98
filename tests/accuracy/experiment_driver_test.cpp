// SPDX-License-Identifier: Apache-2.0
// The driver of experiments: measured methods, memory, filters, passes and subjects.
#include "experiment_driver.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <stdexcept>
#include <string>
#include <thread>

#include "relief/accuracy/experiment.h"
#include "relief/mesh/report.h"

namespace relief::test {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

using testing::ElementsAre;
using testing::SizeIs;

Method method_of(const std::string& name, double rms, std::function<void()> work) {
    Method method;
    method.name = name;
    method.choices = {{"kind", name}};
    method.error = [rms] {
        ErrorStats error;
        error.count = 1;
        error.rms = rms;
        return error;
    };
    method.work = std::move(work);
    method.stored_bytes = 4.0;
    return method;
}

constexpr CostChoice one_thread_alone{.one_thread = true, .all_threads = false, .memory = false};

RunOptions rounds(std::size_t counted, std::size_t warm_up = 0) {
    RunOptions options;
    options.repeats = {counted, warm_up};
    return options;
}

RunOptions untimed() {
    RunOptions options;
    options.is_timed = false;
    return options;
}

TEST(Measured, GivesEachItsOwnCostAndNoneToThoseWithoutWork) {
    std::size_t first = 0;
    std::size_t last = 0;
    PreparedExperiment prepared{.costs = one_thread_alone};
    prepared.methods = {method_of("first", 1.0, [&] { ++first; }), method_of("none", 0.5, {}),
                        method_of("last", 2.0, [&] { ++last; })};
    const Experiment experiment = measured(prepared, rounds(3));
    ASSERT_EQ(experiment.measurements.size(), 3U);
    EXPECT_GT(first, 0U);
    EXPECT_GT(last, 0U);
    const auto& all = experiment.measurements;
    EXPECT_EQ(all[0].cost.one_thread.value().rounds.size(), 3U);
    EXPECT_FALSE(all[1].cost.one_thread);
    EXPECT_TRUE(all[2].cost.one_thread);
    EXPECT_FALSE(all[2].cost.all_threads);
    EXPECT_FALSE(all[2].cost.peak_bytes);
    EXPECT_EQ(all[1].cost.stored_bytes, 4.0);
    EXPECT_TRUE(std::isnan(median_seconds(all[1])));
    EXPECT_FALSE(all[1].is_pareto_optimal);  // It has no time.
    EXPECT_TRUE(all[0].is_pareto_optimal);
    EXPECT_EQ(all[2].choices, prepared.methods[2].choices);
    EXPECT_EQ(all[2].error.rms, 2.0);
}

TEST(Measured, RunsNoRepetitionsWithoutTiming) {
    PreparedExperiment prepared;
    prepared.methods = {method_of("one", 1.0, [] { FAIL(); })};
    const Experiment experiment = measured(prepared, untimed());
    EXPECT_EQ(experiment.measurements[0].cost, Cost{.stored_bytes = 4.0});
    EXPECT_FALSE(experiment.measurements[0].is_pareto_optimal);
}

TEST(Measured, InterleavesAndCountsTheRequestedRounds) {
    std::string calls;
    const auto slow = [&](char name) {
        return [&calls, name] {
            calls += name;
            const std::clock_t begin = std::clock();
            while (std::clock() - begin < 5 * CLOCKS_PER_SEC / 1000) {
            }
        };
    };
    PreparedExperiment prepared{.costs = one_thread_alone};
    prepared.methods = {method_of("a", 1.0, slow('a')), method_of("b", 1.0, slow('b'))};
    const Experiment experiment = measured(prepared, rounds(3, 1));
    EXPECT_THAT(experiment.measurements[0].cost.one_thread.value().rounds, SizeIs(3));
    // Allow for the difference of two clocks.
    EXPECT_GE(median_seconds(experiment.measurements[1]), 4.9e-3);
    // Each work runs once to warm up and once to estimate its time; then one round is not counted.
    EXPECT_EQ(calls, "aabbabababab");
}

TEST(Measured, RepeatsShortWorkWithinARound) {
    std::size_t calls = 0;
    PreparedExperiment prepared{.costs = one_thread_alone};
    prepared.methods = {method_of("short", 1.0, [&] { ++calls; })};
    const Experiment experiment = measured(prepared, rounds(2, 1));
    EXPECT_GT(calls, 2U + 3U * 10U);                              // More than ten per round.
    EXPECT_LT(median_seconds(experiment.measurements[0]), 1e-3);  // The time of one call.
}

TEST(Measured, OneThreadHasTheTimeOfTheProcessor) {
    PreparedExperiment prepared{.costs = {.memory = false}};
    prepared.methods = {method_of(
        "waiting", 1.0, [] { std::this_thread::sleep_for(std::chrono::milliseconds(20)); })};
    const Cost cost = measured(prepared, rounds(3, 1)).measurements[0].cost;
    EXPECT_LT(cost.one_thread.value().spread().p10, 10e-3);
    EXPECT_GT(cost.one_thread.value().spread().p10, 0.0);
    EXPECT_GE(cost.all_threads.value().spread().p10, 20e-3);
}

TEST(Measured, AddsTheNoteOfTheErrorAndFinishes) {
    PreparedExperiment prepared;
    prepared.methods = {method_of("one", 1.0, {})};
    prepared.methods[0].error = [] { return MethodError({}, "A note."); };
    prepared.finish = [](Experiment& report) {
        report.finding = report.measurements.front().note + " And a finding.";
    };
    EXPECT_EQ(measured(prepared, untimed()).finding, "A note. And a finding.");
}

/// An experiment with a method per RMS error, in pairs of float64 and float32.
Experiment with_errors(const std::vector<double>& errors) {
    Experiment experiment{.error_unit = "degrees"};
    for (const double rms : errors) {
        const std::size_t i = experiment.measurements.size();
        const std::string arithmetic = i % 2 == 0 ? "float64" : "float32";
        Measurement& one = experiment.measurements.emplace_back();
        one.method = fmt::format("{}, {}", i / 2, arithmetic);
        one.choices = {{"kernel", std::to_string(i / 2)}, {"arithmetic", arithmetic}};
        one.error = {.count = 1, .rms = rms, .max = 2.0 * rms};
    }
    return experiment;
}

TEST(Finding, HasTheLeastAndTheLargestErrorAndTheEffectOfFloat) {
    Experiment experiment = with_errors({1.0, 1.25, 2.0, 1.5});
    const std::string extremes =
        "'0, float64' has the smallest error, 1 degrees RMS, 2 at most; '1, float64' has the "
        "largest, 2 RMS, 4 at most. float32 changes no RMS error by more than 0.5 degrees";
    EXPECT_EQ(finding_of(experiment, {}), extremes + ".");
    for (std::size_t i = 0; i < 4; ++i)
        experiment.measurements[i].cost.one_thread = Timing{{i % 2 == 0 ? 2.0 : 1.0}};
    EXPECT_EQ(finding_of(experiment, {}), extremes + " and takes 0.50 times as long (median).");
}

TEST(Finding, ComparesTheNamedMethodsWithTheirTimes) {
    Experiment experiment = with_errors({1.0, 1.25, 2.0, 1.5});
    EXPECT_EQ(
        finding_of(experiment, {"1, float64", "0, float32"}),
        "'0, float32' has the smallest error, 1.25 degrees RMS, 2.5 at most; '1, float64' 2.");
    experiment.measurements[2].cost.all_threads = Timing{{0.5}};
    EXPECT_EQ(finding_of(experiment, {"1, float64", "0, float32"}),
              "'0, float32' has the smallest error, 1.25 degrees RMS, 2.5 at most; '1, float64' 2. "
              "Median times: '1, float64' 500 ms.");
}

TEST(Finding, LeavesOutMethodsWithUndefinedResults) {
    Experiment experiment = with_errors({1.0, 1.25});
    experiment.measurements[0].error.undefined = 1;
    EXPECT_EQ(finding_of(experiment, {}).find("'0, float32' has the smallest"), 0U);
    experiment.measurements[1].error.undefined = 1;
    EXPECT_EQ(finding_of(experiment, {}).find("No method has a defined error everywhere."), 0U);
}

/// An experiment whose rounds have the times that `seconds` returns.
PlannedExperiment planned(const std::string& id, std::size_t methods,
                          const std::function<double()>& seconds) {
    const auto prepare = [methods, seconds](const PlanOptions&) {
        PreparedExperiment prepared{.costs = one_thread_alone};
        for (std::size_t i = 0; i < methods; ++i) {
            prepared.methods.push_back(
                method_of(std::string(1, static_cast<char>('a' + i)), 1.0, {}));
            prepared.methods.back().round = seconds;
        }
        return prepared;
    };
    return {id, "Title of " + id, prepare, Subject::bump};
}

PlannedExperiment planned(const std::string& id) {
    return planned(id, 1, [] { return 1.0; });
}

TEST(RunPlanned, ReportsEachMethodBeforeItRuns) {
    std::vector<std::string> told;
    RunOptions options = rounds(2);
    options.passes = 2;
    options.tell = [&](const RunProgress& progress) {
        told.push_back(fmt::format("{} {} {}/{}", progress.title, progress.pass, progress.done,
                                   progress.total));
    };
    options.finished = [&](Experiment& experiment) { told.push_back(experiment.id); };
    const std::vector<Experiment> found = run_planned({planned("a"), planned("b")}, options);
    EXPECT_THAT(told, ElementsAre("Title of a 0 0/2", "Title of b 0 1/2", "Title of a 1 0/2", "a",
                                  "Title of b 1 1/2", "b"));
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0].id, "a");
    EXPECT_EQ(found[1].title, "Title of b");
    EXPECT_EQ(found[1].subject, Subject::bump);
}

TEST(RunPlanned, EndsIfTheCallbackThrows) {
    RunOptions options = untimed();
    options.tell = [](const RunProgress& progress) {
        if (progress.done == 1) throw std::runtime_error("enough");
    };
    std::size_t runs = 0;
    const PlannedExperiment counted{
        "x", "x", [&](const PlanOptions&) { return ++runs, PreparedExperiment{}; }};
    EXPECT_THROW(run_planned({counted, counted}, options), std::runtime_error);
    EXPECT_EQ(runs, 1U);
}

TEST(RunPlanned, SkipsExcludedExperiments) {
    PlannedExperiment left_out = planned("left out");
    left_out.prepare = [](const PlanOptions&) -> PreparedExperiment {
        throw std::runtime_error("prepared");
    };
    RunOptions options = rounds(1);
    options.selects_experiment = [](const std::string& id) { return id == "taken"; };
    const std::vector<Experiment> found = run_planned({left_out, planned("taken")}, options);
    ASSERT_THAT(found, SizeIs(1));
    EXPECT_EQ(found[0].id, "taken");
}

const std::vector<double>& rounds_of(const Experiment& experiment, std::size_t method) {
    return experiment.measurements.at(method).cost.one_thread.value().rounds;
}

TEST(Passes, DivideTheRounds) {
    double clock = 0.0;
    const auto next = [&] { return ++clock; };
    RunOptions options = rounds(7);
    options.passes = 3;
    const std::vector<Experiment> found =
        run_planned({planned("two", 2, next), planned("one", 1, next)}, options);
    // 7 rounds are divided into 3, 2 and 2. In each pass, both methods of the first experiment
    // alternate, then the single method of the second one follows.
    EXPECT_THAT(rounds_of(found[0], 0), ElementsAre(1, 3, 5, 10, 12, 16, 18));
    EXPECT_THAT(rounds_of(found[0], 1), ElementsAre(2, 4, 6, 11, 13, 17, 19));
    EXPECT_THAT(rounds_of(found[1], 0), ElementsAre(7, 8, 9, 14, 15, 20, 21));
}

TEST(Passes, AreAtMostTheNumberOfRounds) {
    std::size_t runs = 0;
    RunOptions options = rounds(3);
    options.passes = 5;
    options.tell = [&](const RunProgress&) { ++runs; };
    run_planned({planned("a")}, options);
    EXPECT_EQ(runs, 3U);
    options.is_timed = false;
    run_planned({planned("a")}, options);
    EXPECT_EQ(runs, 4U);
}

TEST(Passes, PrepareComputeErrorsAndFinishOnce) {
    std::string calls;
    PlannedExperiment plan = planned("a");
    plan.prepare = [&](const PlanOptions&) {
        calls += "prepare ";
        PreparedExperiment prepared{.costs = {.memory = false}};
        prepared.methods = {method_of("one", 1.0, [] {})};
        prepared.methods[0].error = [&] {
            calls += "error ";
            return ErrorStats{};
        };
        prepared.finish = [&](Experiment& report) {
            calls += "finish";
            EXPECT_THAT(report.measurements[0].cost.all_threads.value().rounds, SizeIs(4));
        };
        return prepared;
    };
    RunOptions options = rounds(4);
    options.passes = 2;
    const std::vector<Experiment> found = run_planned({plan}, options);
    EXPECT_EQ(calls, "prepare error finish");
    EXPECT_THAT(rounds_of(found[0], 0), SizeIs(4));
}

TEST(SharedInput, IsMadeOnceByTheFirstThatNeedsIt) {
    int made = 0;
    const SharedInput<int> shared([&] { return std::make_shared<const int>(++made); });
    const SharedInput<int> copy = shared;
    EXPECT_EQ(made, 0);
    EXPECT_EQ(*copy.get(), 1);
    EXPECT_EQ(shared.get(), copy.get());
    EXPECT_EQ(made, 1);
}

TEST(PeakBytes, AreTheMaximumAllocated) {
    constexpr std::size_t size = 64U << 20U;
    const auto touch = [] {
        std::vector<char> memory(size);
        for (std::size_t i = 0; i < size; i += 512)
            memory[i] = static_cast<char>(i);
        volatile const char* kept = memory.data();
        EXPECT_EQ(kept[512], static_cast<char>(512));
    };
#ifdef __SANITIZE_THREAD__
    GTEST_SKIP() << "the process also holds the memory of ThreadSanitizer";
#endif
    const std::optional<std::uint64_t> one = peak_bytes_of(touch);
    if (!one) GTEST_SKIP() << "this system does not tell what a process holds";
    EXPECT_GE(*one, size * 9 / 10);
    EXPECT_LE(peak_bytes_of([] {}).value(), size / 10);
#ifndef __SANITIZE_ADDRESS__  // AddressSanitizer keeps freed memory.
    EXPECT_LE(peak_bytes_of([&] { touch(), touch(); }).value(), size * 11 / 10);
#endif
}

TEST(Subjects, HaveTheExperimentsOfTheirName) {
    for (const EnumName<Subject>& subject : enum_names<Subject>) {
        std::size_t all = 0;
        RunOptions options = untimed();
        options.is_quick = true;
        options.selects_experiment = [&](const std::string& id) {
            EXPECT_TRUE(id.starts_with(std::string(subject.name) + "/")) << id;
            ++all;
            return false;
        };
        EXPECT_TRUE(run_experiments(std::array{subject.value}, options).empty());
        EXPECT_GE(all, 2U) << subject.name;
    }
}

}  // namespace
}  // namespace relief::test
