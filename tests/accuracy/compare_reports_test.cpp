// SPDX-License-Identifier: Apache-2.0
// Two runs against each other: nothing is found where nothing is, and what was changed is found;
// with times drawn at random from fixed seeds, never measured ones.
#include "relief/accuracy/compare_reports.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace relief {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// How the times of a simulated run come about.
struct Simulation {
    std::size_t rounds = 9;
    double noise = 0.05;    ///< Of each round, as a deviation.
    double between = 0.01;  ///< Of a method from run to run, which no round of one run shows.
    double machine = 1.0;   ///< All takes so many times as long.
    /// How much the machine's speed wanders from pass to pass, as a deviation; half as much from
    /// experiment to experiment of a pass.
    double drift = 0.0;
    double interrupted = 0.0;  ///< Part of the rounds that take 1.5 to 3 times as long.
};

/// 8 experiments of 5 methods, on one thread.
std::vector<Experiment> simulated(std::mt19937_64& random, const Simulation& simulation) {
    constexpr std::size_t passes = 3;
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    std::vector<Experiment> experiments;
    std::array<double, passes> speed{};
    for (double& one : speed)
        one = simulation.drift * normal(random);
    for (int e = 0; e < 8; ++e) {
        Experiment experiment;
        experiment.id = "subject/" + std::to_string(e);
        std::array<double, passes> level = speed;
        for (double& one : level)
            one += 0.5 * simulation.drift * normal(random);
        for (int m = 0; m < 5; ++m) {
            Measurement one;
            one.method = "method " + std::to_string(m);
            one.error.rms = 0.1;
            const double run = std::exp(simulation.between * normal(random));
            Timing timing;
            for (std::size_t i = 0; i < simulation.rounds; ++i) {
                const bool is_interrupted = uniform(random) < simulation.interrupted;
                timing.rounds.push_back((m + 1) * 1e-3 * simulation.machine * run *
                                        std::exp(level.at(i * passes / simulation.rounds) +
                                                 simulation.noise * normal(random)) *
                                        (is_interrupted ? 1.5 + 1.5 * uniform(random) : 1.0));
            }
            one.cost.one_thread = timing;
            experiment.measurements.push_back(one);
        }
        experiments.push_back(experiment);
    }
    return experiments;
}

void slow_down(Measurement& one, double factor) {
    for (double& seconds : one.cost.one_thread->rounds)
        seconds *= factor;
}

std::vector<std::string> methods_that_are(const ReportComparison& result, TimeVerdict verdict) {
    std::vector<std::string> names;
    for (const TimeChange& change : result.times) {
        if (change.verdict == verdict) names.push_back(change.experiment + ": " + change.method);
    }
    return names;
}

TEST(CompareReports, FindsNothingInTwoRunsOfTheSame) {
    std::mt19937_64 random(1);
    int without_findings = 0;
    for (int trial = 0; trial < 100; ++trial) {
        Simulation second;
        second.machine = trial % 2 == 0 ? 1.0 : 1.3;
        const ReportComparison result =
            compare_reports(simulated(random, {}), simulated(random, second), true);
        ASSERT_THAT(result.times, SizeIs(40));
        const bool found = !methods_that_are(result, TimeVerdict::slower).empty() ||
                           !methods_that_are(result, TimeVerdict::faster).empty() ||
                           !methods_that_are(result, TimeVerdict::cannot_tell).empty();
        without_findings += found ? 0 : 1;
        EXPECT_TRUE(result.errors.empty());
    }
    EXPECT_GE(without_findings, 95);
}

TEST(CompareReports, FindsWhatIsAThirdSlowerAndNothingElse) {
    std::mt19937_64 random(2);
    int found = 0;
    int found_alone = 0;
    for (int trial = 0; trial < 40; ++trial) {
        Simulation second;
        second.machine = trial % 2 == 0 ? 1.0 : 1.3;
        const std::vector<Experiment> before = simulated(random, {});
        std::vector<Experiment> after = simulated(random, second);
        slow_down(after[3].measurements[2], 4.0 / 3.0);
        const ReportComparison result = compare_reports(before, after, true);
        const std::vector<std::string> slower = methods_that_are(result, TimeVerdict::slower);
        found += std::count(slower.begin(), slower.end(), "subject/3: method 2") == 1 ? 1 : 0;
        found_alone += slower.size() == 1 && slower[0] == "subject/3: method 2" ? 1 : 0;
    }
    EXPECT_GE(found, 38);
    EXPECT_GE(found_alone, 37);
}

/// A machine that other programs use, too: its speed wanders, and rounds are interrupted.
constexpr Simulation busy{
    .rounds = 10, .noise = 0.15, .between = 0.03, .drift = 0.15, .interrupted = 0.25};

TEST(CompareReports, FindsNothingInTwoRunsOfTheSameOnABusyMachine) {
    std::mt19937_64 random(7);
    int false_alarms = 0;
    int false_alarms_of_all = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const ReportComparison result =
            compare_reports(simulated(random, busy), simulated(random, busy), true, 1.1);
        false_alarms += methods_that_are(result, TimeVerdict::slower).empty() &&
                                methods_that_are(result, TimeVerdict::faster).empty()
                            ? 0
                            : 1;
        false_alarms_of_all += result.one_thread.verdict == TimeVerdict::slower ||
                                       result.one_thread.verdict == TimeVerdict::faster
                                   ? 1
                                   : 0;
        // Nor does anything of it prove that the bound of a tenth is kept.
        EXPECT_FALSE(methods_that_are(result, TimeVerdict::cannot_tell).empty());
    }
    EXPECT_LE(false_alarms, 16) << "5 %, and two deviations of such a count";
    EXPECT_LE(false_alarms_of_all, 1) << "0.1 %, and two deviations of such a count";
}

TEST(CompareReports, FindsWhatTakesTwiceAsLongOnABusyMachineOrCannotTell) {
    std::mt19937_64 random(8);
    int found = 0;
    for (int trial = 0; trial < 40; ++trial) {
        const std::vector<Experiment> before = simulated(random, busy);
        std::vector<Experiment> after = simulated(random, busy);
        slow_down(after[3].measurements[2], 2.0);
        const ReportComparison result = compare_reports(before, after, true, 1.1);
        const TimeChange& change = result.times[17];
        ASSERT_EQ(change.method, "method 2");
        found += change.verdict == TimeVerdict::slower ? 1 : 0;
        EXPECT_TRUE(change.verdict == TimeVerdict::slower ||
                    change.verdict == TimeVerdict::cannot_tell);
    }
    EXPECT_LT(found, 40) << "a quarter of the rounds are interrupted";
    // Where one in twenty is, and the speed wanders by a tenth, it is mostly found.
    constexpr Simulation less_busy{
        .rounds = 10, .noise = 0.08, .between = 0.02, .drift = 0.1, .interrupted = 0.05};
    found = 0;
    for (int trial = 0; trial < 40; ++trial) {
        const std::vector<Experiment> before = simulated(random, less_busy);
        std::vector<Experiment> after = simulated(random, less_busy);
        slow_down(after[3].measurements[2], 2.0);
        found += compare_reports(before, after, true, 1.1).times[17].verdict == TimeVerdict::slower
                     ? 1
                     : 0;
    }
    EXPECT_GE(found, 28);
}

TEST(CompareReports, AMethodWhoseRoundsScatterIsNotWithinABound) {
    // All is equal to the bit but for one method, whose rounds scatter so far that its ratio of 2
    // may be chance.
    std::mt19937_64 random(9);
    const Simulation quiet{.rounds = 10, .noise = 0.01, .between = 0.0};
    std::vector<Experiment> before = simulated(random, quiet);
    std::vector<double>& rounds = before[3].measurements[2].cost.one_thread->rounds;
    rounds = {1.0, 5.0, 2.0, 9.0, 3.0, 8.0, 4.0, 1.5, 6.0, 2.5};
    std::vector<Experiment> after = before;
    slow_down(after[3].measurements[2], 2.0);
    const ReportComparison result = compare_reports(before, after, true, 1.1);
    EXPECT_THAT(methods_that_are(result, TimeVerdict::slower), IsEmpty());
    EXPECT_THAT(methods_that_are(result, TimeVerdict::cannot_tell),
                ElementsAre("subject/3: method 2"));
    EXPECT_NEAR(result.times[17].ratio.value, 2.0, 1e-12);
    EXPECT_GT(result.times[17].resolution, 2.0);
    // Without a bound there is nothing to prove; a wide one is kept.
    EXPECT_THAT(methods_that_are(compare_reports(before, after, true), TimeVerdict::cannot_tell),
                IsEmpty());
    EXPECT_THAT(
        methods_that_are(compare_reports(before, after, true, 100.0), TimeVerdict::cannot_tell),
        IsEmpty());
}

TEST(CompareReports, WhatChangedForAllIsToldOnce) {
    std::mt19937_64 random(4);
    Simulation second;
    second.machine = 1.3;
    const ReportComparison result =
        compare_reports(simulated(random, {}), simulated(random, second), true);
    EXPECT_TRUE(result.one_thread.is_judged);
    EXPECT_EQ(result.one_thread.methods, 40U);
    EXPECT_NEAR(result.one_thread.ratio.value, 1.3, 0.02);
    EXPECT_LT(result.one_thread.ratio.low, 1.3);
    EXPECT_GT(result.one_thread.ratio.high, 1.3);
    EXPECT_FALSE(result.all_threads.is_judged);
    EXPECT_THAT(methods_that_are(result, TimeVerdict::slower), IsEmpty());
}

TEST(CompareReports, WhatGotLessFasterThanTheOthersIsNotSlower) {
    std::mt19937_64 random(5);
    const Simulation quiet{9, 0.005, 0.0, 1.0};
    const std::vector<Experiment> before = simulated(random, quiet);
    std::vector<Experiment> after = simulated(random, {9, 0.005, 0.0, 0.7});
    slow_down(after[0].measurements[0], 0.9 / 0.7);
    const ReportComparison same = compare_reports(before, after, true);
    EXPECT_THAT(methods_that_are(same, TimeVerdict::slower), IsEmpty());
    // On another machine, that all others are faster is the machine.
    const ReportComparison other = compare_reports(before, after, false);
    EXPECT_THAT(methods_that_are(other, TimeVerdict::slower), ElementsAre("subject/0: method 0"));
    EXPECT_NEAR(other.times[0].counted, 0.9 / 0.7, 0.02);
}

TEST(CompareReports, WhatScattersFromRunToRunIsNotAChange) {
    // Rounds agree within half a percent, but each run has its own time: by the rounds alone nearly
    // every method would have changed.
    std::mt19937_64 random(6);
    const Simulation restless{9, 0.005, 0.1, 1.0};
    int without_findings = 0;
    for (int trial = 0; trial < 20; ++trial) {
        const ReportComparison result =
            compare_reports(simulated(random, restless), simulated(random, restless), true);
        EXPECT_NEAR(result.one_thread.scatter, 0.1 * std::sqrt(2.0), 0.12);
        without_findings += methods_that_are(result, TimeVerdict::slower).size() <= 1 ? 1 : 0;
    }
    EXPECT_GE(without_findings, 19);
}

Experiment one_measurement(const ErrorFigures& error) {
    Experiment experiment;
    experiment.id = "bump/waves";
    experiment.error_unit = "degrees";
    Measurement one;
    one.method = "sobel3";
    one.error = error;
    experiment.measurements.push_back(one);
    return experiment;
}

TEST(CompareReports, ErrorsCountBeyondRounding) {
    const ErrorFigures before{100, 0, 0.1, 0.05, 0.2, 0.3, {}};
    ErrorFigures rounded = before;
    rounded.rms *= 1.0 + 1e-8;
    EXPECT_TRUE(compare_reports({one_measurement(before)}, {one_measurement(rounded)}, true)
                    .errors.empty());
    ErrorFigures worse = before;
    worse.rms = 0.10001;
    worse.max = 0.33;
    const ReportComparison result =
        compare_reports({one_measurement(before)}, {one_measurement(worse)}, true);
    ASSERT_THAT(result.errors, SizeIs(1));
    EXPECT_EQ(result.errors[0].method, "sobel3");
    EXPECT_EQ(result.errors[0].chart, "");
    ASSERT_THAT(result.errors[0].figures, SizeIs(2));
    EXPECT_EQ(result.errors[0].figures[0].figure, "rms");
    EXPECT_EQ(result.errors[0].worst().figure, "max");
    EXPECT_NEAR(result.errors[0].worst().growth(), 0.1, 1e-12);
}

TEST(CompareReports, ResultsThatBecameUnusableAreEndlessGrowth) {
    ErrorFigures before{100, 0, 0.0, 0.0, 0.0, 0.0, {}};
    ErrorFigures after = before;
    after.undefined = 1;
    after.count = 99;
    const ReportComparison result =
        compare_reports({one_measurement(before)}, {one_measurement(after)}, true);
    ASSERT_THAT(result.errors, SizeIs(1));
    EXPECT_EQ(result.errors[0].worst().figure, "undefined");
    EXPECT_TRUE(std::isinf(result.errors[0].worst().growth()));
    EXPECT_EQ((FigureChange{"rms", nan, 0.1}.growth()), -1.0);
    EXPECT_EQ((FigureChange{"rms", 0.2, 0.1}.growth()), -0.5);
    EXPECT_TRUE(std::isinf(FigureChange{"at 1e-12", 0.1, nan}.growth()));
}

TEST(CompareReports, CurvesAreComparedPointByPoint) {
    Experiment before = one_measurement({});
    before.charts.push_back({"scale", "", "", "", true, {}, {{"naive", {}, {}, {}, {}}}});
    before.charts[0].curves[0].points = {{1e-12, nan}, {1e-6, 0.5}, {1.0, 0.1}};
    Experiment after = before;
    after.charts[0].curves[0].points = {{1e-6, nan}, {1.0, 0.1}, {10.0, 0.1}};
    const ReportComparison result = compare_reports({before}, {after}, true);
    ASSERT_THAT(result.errors, SizeIs(1));
    EXPECT_EQ(result.errors[0].chart, "scale");
    ASSERT_THAT(result.errors[0].figures, SizeIs(1));
    EXPECT_EQ(result.errors[0].figures[0].figure, "at 1e-06");
    EXPECT_TRUE(std::isinf(result.errors[0].worst().growth()));
}

TEST(CompareReports, PointsOfACurveAreToldApartByTheirPlaceAlone) {
    Experiment before = one_measurement({});
    before.charts.push_back({"angle", "", "", "", false, {}, {{"fit", {}, {}, {}, {}}}});
    before.charts[0].curves[0].points = {{-1.0, 0.5}, {0.0, 0.1}, {1e-30, 0.2}, {1.0, 0.3}};
    EXPECT_THAT(compare_reports({before}, {before}, true).errors, IsEmpty());
    Experiment after = before;
    after.charts[0].curves[0].points[1].error = 0.4;
    const ReportComparison result = compare_reports({before}, {after}, true);
    ASSERT_THAT(result.errors, SizeIs(1));
    ASSERT_THAT(result.errors[0].figures, SizeIs(1));
    EXPECT_EQ(result.errors[0].figures[0].figure, "at 0");
}

TEST(CompareReports, CurvesAndPointsWithoutAPartnerAreListed) {
    Experiment before = one_measurement({});
    before.charts.push_back({"scale", "", "", "", true, {}, {{"naive", {}, {}, {}, {}}}});
    before.charts[0].curves[0].points = {{1.0, 0.1}, {10.0, 0.2}};
    before.charts.push_back({"offset", "", "", "", true, {}, {{"naive", {}, {}, {}, {}}}});
    Experiment after = before;
    after.charts.pop_back();
    after.charts[0].curves[0].points = {{1.0, 0.1}, {100.0, 0.3}};
    const ReportComparison result = compare_reports({before}, {after}, true);
    EXPECT_THAT(result.gone, ElementsAre("bump/waves, chart scale: naive at 10",
                                         "bump/waves, chart offset: naive"));
    EXPECT_THAT(result.added, ElementsAre("bump/waves, chart scale: naive at 100"));
    EXPECT_THAT(result.errors, IsEmpty());
}

TEST(CompareReports, ListsWhatHasNoPartner) {
    Experiment before = one_measurement({});
    Experiment after = before;
    after.measurements[0].method = "scharr3";
    Experiment other = before;
    other.id = "bump/noise";
    Experiment resized = other;
    resized.input = "another size";
    const ReportComparison result = compare_reports({before, other}, {after, resized}, true);
    EXPECT_THAT(result.gone, ElementsAre("bump/waves: sobel3"));
    EXPECT_THAT(result.added, ElementsAre("bump/waves: scharr3"));
    EXPECT_THAT(result.other_input, ElementsAre("bump/noise"));
    EXPECT_EQ(result.methods, 0U);
}

}  // namespace
}  // namespace relief
