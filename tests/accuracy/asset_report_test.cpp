// SPDX-License-Identifier: Apache-2.0
// Recommendations for invented measurements, computed by hand.
#include "relief/accuracy/asset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace relief {
using namespace relief::accuracy;

namespace {

using testing::HasSubstr;

Measurement measured(const std::string& name, double error, double seconds) {
    Measurement one;
    one.method = name;
    one.error = {.count = 100,
                 .undefined = 0,
                 .rms = error,
                 .mean = error,
                 .p99 = 2.0 * error,
                 .max = 3.0 * error,
                 .psnr = {}};
    one.cost.one_thread = Timing{{seconds, seconds, seconds}};
    return one;
}

Experiment experiment_of(std::vector<Measurement> measurements) {
    Experiment experiment;
    experiment.error_unit = "degrees";
    experiment.measurements = std::move(measurements);
    return experiment;
}

/// Methods from 1 degree in 10 ms to 0.04 degrees in 123 ms.
Experiment usual() {
    return experiment_of({measured("rough", 1.0, 0.010), measured("poor", 1.2, 0.020),
                          measured("good", 0.05, 0.041), measured("best", 0.04, 0.123)});
}

TEST(Recommended, IsTheKnee) {
    // error^3 x cost: 1e-2, 3.5e-2, 5.1e-6, 7.9e-6.
    const Recommendation found = recommended(usual(), {});
    EXPECT_EQ(found.method, 2U);
    EXPECT_EQ(found.next, 3U);
    EXPECT_EQ(found.description,
              "good: 0.05 degrees RMS at 41.0 ms; the next more accurate (best) takes 3 times as "
              "long for 0.01 degrees less");
}

TEST(Recommended, AcceptsTimeUpToTheCubeOfTheAccuracyGain) {
    // Half the error is worth eight times the time, but not more.
    const auto second_for = [](double seconds) {
        return recommended(experiment_of({measured("a", 1.0, 0.01), measured("b", 0.5, seconds)}),
                           {});
    };
    EXPECT_EQ(second_for(0.079).method, 1U);
    EXPECT_EQ(second_for(0.081).method, 0U);
    EXPECT_EQ(second_for(0.079).next, std::nullopt);
    EXPECT_THAT(second_for(0.079).description, HasSubstr("no other method is more accurate"));
}

TEST(Recommended, PrefersTheSmallestOfEquals) {
    Experiment experiment =
        experiment_of({measured("wide", 0.5, 0.010), measured("narrow", 0.505, 0.0105),
                       measured("flat", 0.5, 0.012)});
    experiment.measurements[0].cost.stored_bytes = 12;
    experiment.measurements[1].cost.stored_bytes = 6;  // Its product is 8% larger.
    experiment.measurements[2].cost.stored_bytes = 3;  // Its product is 20% larger.
    EXPECT_EQ(recommended(experiment, {}).method, 1U);
}

TEST(Recommended, NextMethodOfEqualTimeIsDescribedAsEqual) {
    RecommendationRule rule;
    rule.request.kind = ErrorKind::rms;
    rule.request.max_error = 0.5;
    EXPECT_EQ(
        recommended(experiment_of({measured("a", 0.5, 0.0100), measured("b", 0.4, 0.0101)}), rule)
            .description,
        "a: 0.5 degrees RMS at 10.0 ms; the next more accurate (b) takes about as long for 0.1 "
        "degrees less");
}

TEST(Recommended, IgnoresGainsBelowTheUncertaintyOfTheReference) {
    RecommendationRule rule;
    // Errors become 2.24 and 2.0004, worth 1.4 times the cost at most; "good" costs 4.1 times as
    // much.
    rule.negligible_error = 2.0;
    EXPECT_EQ(recommended(usual(), rule).method, 0U);
}

struct LimitCase {
    std::optional<double> max_error, max_seconds;
    ErrorKind kind;
    std::optional<std::size_t> method;
    const char* description = "";  ///< A part of it.
};

TEST(Recommended, KeepsWithinLimits) {
    // 99 %: 2, 2.4, 0.1 and 0.08; maximum: 3, 3.6, 0.15 and 0.12.
    using enum ErrorKind;
    for (const LimitCase& row : std::vector<LimitCase>{
             {0.045, {}, rms, 3},
             {2.0, {}, rms, 0},
             {0.09, {}, p99, 3, "best: 0.04 degrees RMS, 0.08 degrees (99 %) at "},
             {2.0, {}, max, 2},
             {0.01,
              {},
              max,
              {},
              "no method is within 0.01 degrees (maximum): the smallest error is 0.12, with best"},
             {{}, 0.1, p99, 2},
             {{}, 0.03, p99, 0},
             {{}, 0.001, p99, {}, "no method is within 1.00 ms: the fastest takes 10.0 ms, with "},
             {0.045,
              0.1,
              rms,
              {},
              "no method is within 0.045 degrees (RMS) and 100 ms: the fastest with that error "
              "takes 123 ms, with best"}}) {
        RecommendationRule rule;
        rule.request = {row.max_error, row.max_seconds, row.kind};
        const Recommendation found = recommended(usual(), rule);
        EXPECT_EQ(found.method, row.method) << found.description;
        EXPECT_THAT(found.description, HasSubstr(row.description));
    }
}

TEST(Recommended, AddsTheErrorOfTheReferenceInTheStatisticOfTheLimit) {
    RecommendationRule rule;
    rule.request.max_error = 0.09;
    rule.limited_reference = 0.05;
    EXPECT_EQ(recommended(usual(), rule).method, std::nullopt);
}

TEST(Recommended, ExcludesUnusableMethods) {
    Experiment experiment = usual();
    const std::vector<unsigned char> choosable = {1, 1, 0, 1};
    RecommendationRule rule;
    rule.choosable = choosable;
    EXPECT_EQ(recommended(experiment, rule).method, 3U);
    experiment.measurements[3].error.undefined = 1;
    EXPECT_EQ(recommended(experiment, rule).method, 0U);
    EXPECT_EQ(recommended(experiment_of({}), {}).method, std::nullopt);
    EXPECT_EQ(recommended(experiment_of({}), {}).description, "nothing could be measured");
}

TEST(Recommended, MinimizesBytesIfRequested) {
    Experiment experiment = usual();
    experiment.measurements[0].cost.stored_bytes = 4;
    experiment.measurements[1].cost.stored_bytes = 4;
    experiment.measurements[2].cost.stored_bytes = 8;
    experiment.measurements[3].cost.stored_bytes = 28;
    RecommendationRule rule;
    rule.cost = CostKind::bytes;
    rule.request.max_seconds = 1e-9;  // Has no effect on bytes.
    const Recommendation found = recommended(experiment, rule);
    EXPECT_EQ(found.description,
              "good: 0.05 degrees RMS at 8 bytes; the next more accurate (best) takes 28 bytes for "
              "0.01 degrees less");
}

TEST(Recommended, CountsTheErrorOfTheReferenceToo) {
    Experiment experiment = usual();
    experiment.reference_error = 0.12;
    RecommendationRule rule;
    rule.request.kind = ErrorKind::rms;
    rule.reference = "the map itself";
    // "good" has 0.05 and "best" 0.04, with the reference 0.13 and 0.1265.
    rule.request.max_error = 0.131;
    Recommendation found = recommended(experiment, rule);
    EXPECT_EQ(found.method, 2U);
    EXPECT_EQ(found.description,
              "good: 0.13 degrees RMS expected (the map itself 0.12, this method adds 0.05) at "
              "41.0 ms; the next more accurate (best) takes 3 times as long for 0.01 degrees less");
    rule.request.max_error = 0.128;
    EXPECT_EQ(recommended(experiment, rule).method, 3U);
    // The limit exceeds the error of each method, but not the expected error.
    rule.request.max_error = 0.125;
    found = recommended(experiment, rule);
    EXPECT_EQ(found.method, std::nullopt);
    EXPECT_EQ(found.description,
              "no method is within 0.125 degrees (RMS): the smallest error is 0.126, with best "
              "(the map itself "
              "0.12)");
    // As an invisible error, it reduces the value of the accurate methods.
    experiment.reference_error = 2.0;
    EXPECT_EQ(recommended(experiment, {}).method, 0U);
}

TEST(Recommended, NamesTheStatisticAndTheRangeOfAnError) {
    Experiment experiment = usual();
    experiment.reference_error = 0.12;
    experiment.reference_error_upper = 1.2;
    RecommendationRule rule;
    rule.reference = "the map itself";
    EXPECT_THAT(
        recommended(experiment, rule).description,
        HasSubstr("good: 0.13 to 1.2 degrees RMS expected (the map itself 0.12 to 1.2, this "
                  "method adds 0.05) at "));
    rule.request.kind = ErrorKind::max;
    for (Measurement& one : experiment.measurements)
        one.error.max = 10.0 * one.error.rms;
    rule.request.max_error = 0.6;
    EXPECT_THAT(recommended(experiment, rule).description,
                HasSubstr("this method adds 0.05), 0.514 degrees (maximum) at "));
    rule.request.max_error = 0.1;
    EXPECT_THAT(recommended(experiment, rule).description,
                HasSubstr("no method is within 0.1 degrees (maximum): the smallest error is "));
}

TEST(Recommended, KeepsNoLimitIfTheReferenceIsUnknown) {
    RecommendationRule rule;
    rule.request.kind = ErrorKind::rms;
    rule.reference = "the unknown loss of the file's JPEG compression";
    rule.is_reference_unknown = true;
    EXPECT_THAT(recommended(usual(), rule).description,
                HasSubstr("good: 0.05 degrees RMS, and the unknown loss of the file's JPEG "
                          "compression at "));
    rule.request.max_error = 90.0;
    const Recommendation bounded = recommended(usual(), rule);
    EXPECT_EQ(bounded.method, std::nullopt);
    EXPECT_EQ(
        bounded.description,
        "no method is known to be within 90 degrees (RMS), because of the unknown loss of the "
        "file's JPEG compression");
}

TEST(Recommended, WithoutTimesMinimizesBytesThenWork) {
    Experiment experiment =
        experiment_of({measured("large", 0.01, 0.1), measured("work", 0.2, 0.1),
                       measured("least", 0.3, 0.1), measured("rough", 2.0, 0.1)});
    const std::vector<double> bytes = {6.0, 3.0, 3.0, 3.0};
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        experiment.measurements[i].cost = {};
        experiment.measurements[i].cost.stored_bytes = bytes[i];
    }
    const std::vector<double> nominal_costs = {5.0, 20.0, 10.0, 1.0};
    RecommendationRule rule;
    rule.request.kind = ErrorKind::rms;
    rule.nominal_costs = nominal_costs;
    rule.request.max_error = 0.5;
    EXPECT_EQ(recommended(experiment, rule).method, 2U);
    rule.request.max_error = 0.25;
    EXPECT_EQ(recommended(experiment, rule).method, 1U);
    rule.request.max_error = 0.1;
    EXPECT_EQ(recommended(experiment, rule).method, 0U);
}

TEST(Recommended, WithoutTimesAndBoundsIsTheMostAccurate) {
    Experiment experiment = usual();
    for (Measurement& one : experiment.measurements)
        one.cost = {};
    EXPECT_EQ(recommended(experiment, {}).method, 3U);
    EXPECT_EQ(recommended(experiment, {}).description,
              "best: 0.04 degrees RMS; no other method is more accurate");
}

}  // namespace
}  // namespace relief
