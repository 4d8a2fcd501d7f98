// SPDX-License-Identifier: Apache-2.0
// Rounds of several passes come together, and a busy moment does not move what they say.
#include "relief/accuracy/passes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "relief/accuracy/measure.h"

namespace relief {
namespace {

using testing::ElementsAre;
using testing::SizeIs;

RunOptions counted_rounds(std::size_t counted) {
    RunOptions options;
    options.repeats = {counted, 0};
    return options;
}

/// An experiment of methods whose rounds take what `seconds` says.
Experiment timed_by(const RunOptions& options, std::size_t methods,
                    const std::function<double(std::size_t)>& seconds) {
    Experiment experiment;
    for (const Timing& timing : rounds_in_turns(methods, options, seconds)) {
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
            return std::vector{timed_by(options, 2, next), timed_by(options, 1, next)};
        });
    EXPECT_THAT(passes, ElementsAre(0, 1, 2));
    // 7 rounds are 3, 2 and 2: of a pass, first both methods of one experiment in turns, then the
    // only one of the other.
    EXPECT_THAT(rounds_of(found[0], 0), ElementsAre(1, 3, 5, 10, 12, 16, 18));
    EXPECT_THAT(rounds_of(found[0], 1), ElementsAre(2, 4, 6, 11, 13, 17, 19));
    EXPECT_THAT(rounds_of(found[1], 0), ElementsAre(7, 8, 9, 14, 15, 20, 21));
}

TEST(Passes, ABusyMomentIsInOneOfThem) {
    // All of pass 1 takes twice as long for one experiment: its medians are still those of others.
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
    const auto truths_of = [&](const RunOptions& options) {
        const int first = made_once(options, [&] { return ++made; });
        const std::string second = made_once(options, [&] { return std::to_string(++made); });
        return std::to_string(first) + second;
    };
    std::string all;
    run_in_passes(3, counted_rounds(3), [&](const RunOptions& options, std::size_t) {
        all += truths_of(options) + " ";
        return std::vector<Experiment>();
    });
    EXPECT_EQ(all, "12 12 12 ");
    EXPECT_EQ(truths_of({}), "34") << "without passes, each time";
}

TEST(Passes, OfOtherMethodsAreRefused) {
    const auto timed_methods = [](const RunOptions& options, std::size_t pass) {
        return std::vector{timed_by(options, 2 + pass, [](std::size_t) { return 1.0; })};
    };
    EXPECT_THROW(run_in_passes(2, counted_rounds(4), timed_methods), std::runtime_error);
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

}  // namespace
}  // namespace relief
