// SPDX-License-Identifier: Apache-2.0
// The driver of experiments: measured methods, planned experiments, passes and subjects.
#include "experiment_driver.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "relief/accuracy/experiment.h"
#include "relief/accuracy/measure.h"
#include "relief/mesh/report.h"

namespace relief {
namespace {

MeasuredMethod method_of(const std::string& name, double rms, std::function<void()> work) {
    MeasuredMethod method;
    method.name = name;
    method.choices = {{"kind", name}};
    method.error.count = 1;
    method.error.rms = rms;
    method.work = std::move(work);
    method.stored_bytes = 4.0;
    return method;
}

TEST(MeasureMethods, GivesEachItsOwnCostAndNoneToThoseWithoutWork) {
    RunOptions options;
    options.repeats = {3, 0};
    std::size_t first = 0;
    std::size_t last = 0;
    const std::vector<MeasuredMethod> methods = {method_of("first", 1.0, [&] { ++first; }),
                                                 method_of("none", 0.5, {}),
                                                 method_of("last", 2.0, [&] { ++last; })};
    Experiment experiment;
    measure_methods(methods, options, {.one_thread = true, .all_threads = false, .memory = false},
                    experiment);
    ASSERT_EQ(experiment.measurements.size(), 3U);
    EXPECT_GT(first, 0U);
    EXPECT_GT(last, 0U);
    EXPECT_EQ(experiment.measurements[0].cost.one_thread.value().rounds.size(), 3U);
    EXPECT_FALSE(experiment.measurements[1].cost.one_thread);
    EXPECT_TRUE(experiment.measurements[2].cost.one_thread);
    EXPECT_EQ(experiment.measurements[1].cost.stored_bytes, 4.0);
    EXPECT_TRUE(std::isnan(median_seconds(experiment.measurements[1])));
    EXPECT_FALSE(experiment.measurements[1].is_pareto_optimal);  // It has no time.
    EXPECT_TRUE(experiment.measurements[0].is_pareto_optimal);
    EXPECT_EQ(experiment.measurements[2].choices, methods[2].choices);
}

TEST(MeasureMethods, RunsNothingWhereNothingIsTimed) {
    RunOptions options;
    options.is_timed = false;
    const std::vector<MeasuredMethod> methods = {method_of("one", 1.0, [] { FAIL(); })};
    Experiment experiment;
    measure_methods(methods, options, {}, experiment);
    EXPECT_FALSE(experiment.measurements[0].cost.one_thread);
    EXPECT_FALSE(experiment.measurements[0].is_pareto_optimal);
}

TEST(Truest, HasTheLeastErrorOfThoseThatAreDefined) {
    Experiment experiment;
    EXPECT_EQ(most_accurate(experiment), nullptr);
    for (const double rms : {3.0, 1.0, 2.0}) {
        experiment.measurements.emplace_back();
        experiment.measurements.back().error.count = 1;
        experiment.measurements.back().error.rms = rms;
    }
    EXPECT_EQ(most_accurate(experiment), &experiment.measurements[1]);
    experiment.measurements[1].error.undefined = 1;
    EXPECT_EQ(most_accurate(experiment), &experiment.measurements[2]);
}

TEST(ArithmeticFinding, ComparesPairsOfTheSameMethod) {
    Experiment experiment;
    for (const double rms : {1.0, 1.25, 2.0, 1.5}) {
        experiment.measurements.emplace_back();
        experiment.measurements.back().error.rms = rms;
    }
    EXPECT_EQ(arithmetic_finding(experiment, "kernels"),
              "float32 changes no RMS error by more than 0.5 degrees.");
    for (std::size_t i = 0; i < 4; ++i)
        experiment.measurements[i].cost.one_thread = Timing{{i % 2 == 0 ? 2.0 : 1.0}};
    EXPECT_EQ(arithmetic_finding(experiment, "kernels"),
              "float32 changes no RMS error by more than 0.5 degrees and takes 0.50 times as long "
              "(median of the kernels).");
}

TEST(FittedCurve, HasTheSlopeOfItsPoints) {
    const Curve curve = fitted_curve("m", {{1.0, 8.0}, {2.0, 2.0}, {4.0, 0.5}}, -2.0);
    EXPECT_NEAR(curve.order.value(), -2.0, 1e-12);
    EXPECT_EQ(curve.expected_order, -2.0);
    EXPECT_EQ(curve.points.size(), 3U);
}

PlannedExperiment planned(const std::string& name) {
    return {"Title of " + name, [name] {
                Experiment experiment;
                experiment.id = name;
                return experiment;
            }};
}

TEST(RunPlanned, TellsOfEachBeforeItAndGivesItsTitle) {
    std::vector<std::string> told;
    RunOptions options;
    options.tell = [&](const std::string& title, std::size_t done, std::size_t total) {
        told.push_back(title + " " + std::to_string(done) + "/" + std::to_string(total));
    };
    const std::vector<PlannedExperiment> plan = {planned("a"), planned("b")};
    const std::vector<Experiment> found = run_planned(plan, options);
    EXPECT_THAT(told, testing::ElementsAre("Title of a 0/2", "Title of b 1/2"));
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0].id, "a");
    EXPECT_EQ(found[1].title, "Title of b");
}

TEST(RunPlanned, EndsWhereTheTellerThrows) {
    RunOptions options;
    options.tell = [](const std::string&, std::size_t done, std::size_t) {
        if (done == 1) throw std::runtime_error("enough");
    };
    std::size_t runs = 0;
    const PlannedExperiment counted{"x", [&] { return ++runs, Experiment{}; }};
    const std::vector<PlannedExperiment> plan = {counted, counted};
    EXPECT_THROW(run_planned(plan, options), std::runtime_error);
    EXPECT_EQ(runs, 1U);
}

using testing::ElementsAre;
using testing::SizeIs;

RunOptions counted_rounds(std::size_t counted) {
    RunOptions options;
    options.repeats = {counted, 0};
    return options;
}

/// An experiment whose rounds have the times that `seconds` returns.
Experiment timed_by(const RunOptions& options, std::size_t methods,
                    const std::function<double(std::size_t)>& seconds,
                    const std::string& group = "rounds") {
    Experiment experiment;
    for (const Timing& timing : measure_interleaved_rounds(group, methods, options, seconds)) {
        experiment.measurements.emplace_back().cost.one_thread = timing;
    }
    return experiment;
}

const std::vector<double>& rounds_of(const Experiment& experiment, std::size_t method) {
    return experiment.measurements.at(method).cost.one_thread->rounds;
}

TEST(Passes, ShareTheRoundsAndTheLastOneHasAll) {
    std::vector<std::size_t> passes;
    double clock = 0.0;
    const std::vector<Experiment> found =
        run_in_passes(3, counted_rounds(7), [&](const RunOptions& options, std::size_t pass) {
            passes.push_back(pass);
            const auto next = [&](std::size_t) { return ++clock; };
            return std::vector{timed_by(options, 2, next), timed_by(options, 1, next, "others")};
        });
    EXPECT_THAT(passes, ElementsAre(0, 1, 2));
    // 7 rounds are divided into 3, 2 and 2. In each pass, both methods of the first experiment
    // alternate, then the single method of the second one follows.
    EXPECT_THAT(rounds_of(found[0], 0), ElementsAre(1, 3, 5, 10, 12, 16, 18));
    EXPECT_THAT(rounds_of(found[0], 1), ElementsAre(2, 4, 6, 11, 13, 17, 19));
    EXPECT_THAT(rounds_of(found[1], 0), ElementsAre(7, 8, 9, 14, 15, 20, 21));
}

TEST(Passes, ABusyMomentIsInOneOfThem) {
    // All of pass 1 is twice as slow for one experiment; its medians stay those of the other
    // passes.
    const std::vector<Experiment> found =
        run_in_passes(3, counted_rounds(9), [](const RunOptions& options, std::size_t pass) {
            return std::vector{
                timed_by(options, 2, [&](std::size_t) { return pass == 1 ? 2.0 : 1.0; })};
        });
    EXPECT_EQ(found[0].measurements[0].cost.one_thread->spread().median, 1.0);
    EXPECT_EQ(found[0].measurements[0].cost.one_thread->spread().p90, 2.0);
}

TEST(Passes, AreNoMoreThanThereIsToDo) {
    std::size_t runs = 0;
    const auto count = [&](const RunOptions&, std::size_t) {
        ++runs;
        return std::vector<Experiment>();
    };
    run_in_passes(5, counted_rounds(3), count);
    EXPECT_EQ(runs, 3U);
    RunOptions untimed = counted_rounds(9);
    untimed.is_timed = false;
    run_in_passes(5, untimed, count);
    EXPECT_EQ(runs, 4U);
}

TEST(Passes, MeasuredWorkHasItsRoundsOfAllPasses) {
    std::size_t calls = 0;
    const std::vector<std::function<void()>> works = {[&] { ++calls; }};
    const std::vector<Experiment> found =
        run_in_passes(2, counted_rounds(4), [&](const RunOptions& options, std::size_t) {
            Experiment experiment;
            experiment.measurements.emplace_back().cost = measure_costs(works, options).front();
            return std::vector{experiment};
        });
    const Cost& cost = found[0].measurements[0].cost;
    EXPECT_THAT(cost.one_thread.value().rounds, SizeIs(4));
    EXPECT_THAT(cost.all_threads.value().rounds, SizeIs(4));
    EXPECT_GT(calls, 0U);
}

TEST(Passes, WhatIsTheSameInAllIsMadeOnce) {
    int made = 0;
    const auto references_of = [&](const RunOptions& options) {
        const int first = computed_once(options, "first", [&] { return ++made; });
        const std::string second =
            computed_once(options, "second", [&] { return std::to_string(++made); });
        return std::to_string(first) + second;
    };
    std::string all;
    run_in_passes(3, counted_rounds(3), [&](const RunOptions& options, std::size_t) {
        all += references_of(options) + " ";
        return std::vector<Experiment>();
    });
    EXPECT_EQ(all, "12 12 12 ");
    EXPECT_EQ(references_of({}), "34") << "without passes, each time";
}

TEST(Passes, FindRoundsAndResultsByNameInAnyOrder) {
    double clock = 0.0;
    std::string all;
    const std::vector<Experiment> found =
        run_in_passes(2, counted_rounds(2), [&](const RunOptions& options, std::size_t pass) {
            std::vector<std::string> names = {"a", "b"};
            if (pass == 1) std::swap(names[0], names[1]);
            std::vector<Experiment> experiments;
            for (const std::string& name : names) {
                all += computed_once(options, name, [&] { return name; });
                experiments.push_back(timed_by(
                    options, 1, [&](std::size_t) { return ++clock; }, name));
            }
            return experiments;
        });
    EXPECT_EQ(all, "abba");
    EXPECT_THAT(rounds_of(found[0], 0), ElementsAre(2, 3));  // b
    EXPECT_THAT(rounds_of(found[1], 0), ElementsAre(1, 4));  // a
}

TEST(Passes, OfOtherMethodsAreRefused) {
    const auto timed_methods = [](const RunOptions& options, std::size_t pass) {
        return std::vector{timed_by(options, 2 + pass, [](std::size_t) { return 1.0; })};
    };
    EXPECT_THROW(run_in_passes(2, counted_rounds(4), timed_methods), std::runtime_error);
}

TEST(Passes, FindTheRoundsOfAPlannedExperimentInAnyOrder) {
    const auto planned_with = [](const RunOptions& options, const std::string& title,
                                 std::size_t methods, double seconds) {
        return PlannedExperiment{
            title,
            [=] { return timed_by(options, methods, [=](std::size_t) { return seconds; }); }};
    };
    const std::vector<Experiment> last =
        run_in_passes(2, counted_rounds(4), [&](const RunOptions& options, std::size_t pass) {
            std::vector<PlannedExperiment> plan = {planned_with(options, "one", 1, 1.0),
                                                   planned_with(options, "two", 2, 2.0)};
            if (pass == 1) std::swap(plan[0], plan[1]);
            return run_planned(plan, options);
        });
    EXPECT_EQ(last[0].title, "two");
    EXPECT_THAT(rounds_of(last[0], 1), ElementsAre(2.0, 2.0, 2.0, 2.0));
    EXPECT_THAT(rounds_of(last[1], 0), ElementsAre(1.0, 1.0, 1.0, 1.0));
}

TEST(Passes, EndWithWhatAnExperimentThrows) {
    std::size_t runs = 0;
    EXPECT_THROW(run_in_passes(3, counted_rounds(9),
                               [&](const RunOptions&, std::size_t) -> std::vector<Experiment> {
                                   ++runs;
                                   throw std::runtime_error("no");
                               }),
                 std::runtime_error);
    EXPECT_EQ(runs, 1U);
}

TEST(Subjects, HaveWordsThatLeadBackToThem) {
    for (const Subject subject : subjects_with_experiments())
        EXPECT_EQ(subject_from(name_of(subject)), subject);
    EXPECT_EQ(name_of(Subject::stability), "stability");
    EXPECT_THROW(subject_from("colour"), InvalidInput);
}

TEST(Subjects, ThatDrawAreKnown) {
    EXPECT_TRUE(uses_opengl(Subject::shading));
    EXPECT_TRUE(uses_opengl(Subject::tangents));
    EXPECT_FALSE(uses_opengl(Subject::bump));
}

}  // namespace
}  // namespace relief
