// SPDX-License-Identifier: Apache-2.0
// Methods measured on a map, and the cheapest within a bound.
#include "relief/mesh/bump_experiment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "relief/mesh/error.h"
#include "support/height_fields.h"

namespace relief {
namespace {

using testing::HasSubstr;

constexpr std::array both_arithmetics = {Arithmetic::float32, Arithmetic::float64};
constexpr std::array all_depths = {8, 16, 32};
constexpr std::array as_stored = {false};
constexpr std::array both_ways = {false, true};

BumpField field_of(FieldCoding coding, double shortest = 32.0) {
    return make_bump_field({"", FieldShape::waves, shortest, 0.3, coding, 0.0, 5}, 128, 96);
}

BumpExperimentOptions untimed(const BumpField& field) {
    BumpExperimentOptions options;
    options.bump = field.options;
    options.repeats = {0, 0};
    return options;
}

const BumpMeasurement& measurement_of(const BumpExperiment& experiment, const BumpMethod& method) {
    for (const BumpMeasurement& one : experiment.measurements) {
        if (one.method == method) return one;
    }
    throw std::runtime_error("not measured");
}

TEST(BumpExperiment, OnAKnownFieldTheErrorsAreThoseOfTheirMethods) {
    const BumpField field = field_of(FieldCoding::float32);
    const auto methods = bump_methods(4, all_depths, both_arithmetics, as_stored);
    ASSERT_EQ(methods.size(), 60U);
    const BumpExperiment experiment = measure_bump(field, methods, untimed(field));
    EXPECT_FALSE(experiment.reference.method);
    EXPECT_EQ(experiment.texels, 128 * 96);
    const auto rms = [&](Kernel kernel, Arithmetic arithmetic, int bits) {
        return measurement_of(experiment, {kernel, 4, arithmetic, bits, false}).error.rms;
    };
    // As direct measurement has it.
    BumpOptions sobel = field.options;
    sobel.kernel = Kernel::sobel3;
    sobel.arithmetic = Arithmetic::float64;
    Report report;
    EXPECT_NEAR(rms(Kernel::sobel3, Arithmetic::float64, 32),
                field_error(normals_from_height(field.heights, sobel, report), field).rms, 1e-6);
    // 8 bits of output cost a sixth of a degree, 16 bits 250 times less.
    EXPECT_NEAR(rms(Kernel::central7, Arithmetic::float64, 8), 0.18, 0.03);
    EXPECT_NEAR(rms(Kernel::central7, Arithmetic::float64, 16), 0.0007, 0.0002);
    EXPECT_LT(rms(Kernel::central7, Arithmetic::float64, 32), 2e-5);
    EXPECT_GT(rms(Kernel::sobel3, Arithmetic::float64, 32),
              100.0 * rms(Kernel::central5, Arithmetic::float64, 32));
}

TEST(BumpExperiment, OnAMapTheReferenceIsTheTruestKnownAndSaysSo) {
    const BumpField field = field_of(FieldCoding::bits8);
    const auto methods = bump_methods(4, all_depths, both_arithmetics, both_ways);
    const BumpExperiment experiment =
        measure_bump(sample_of(field.heights), methods, untimed(field));
    ASSERT_TRUE(experiment.reference.method);
    EXPECT_TRUE(experiment.reference.method->destaircased);
    EXPECT_EQ(experiment.reference.method->arithmetic, Arithmetic::float64);
    EXPECT_GT(experiment.reference.reference_degrees, 0.01);
    EXPECT_THAT(experiment.reference.words, HasSubstr("its steps smoothed away"));
    // It is truer than what the choice for the map as it is would give.
    BumpOptions plain = field.options;
    plain.kernel = experiment.choice.kernel;
    plain.gaussian_radius = experiment.choice.gaussian_radius;
    Report report;
    const double of_plain =
        field_error(normals_from_height(field.heights, plain, report), field).rms;
    const BumpExperiment known =
        measure_bump(field, std::array{*experiment.reference.method}, untimed(field));
    EXPECT_LT(known.measurements[0].error.rms, of_plain);
}

TEST(BumpExperiment, TheCheapestWithinABoundIsNoDearerThanNeeded) {
    const BumpField field = field_of(FieldCoding::float32);
    const auto methods = bump_methods(4, all_depths, both_arithmetics, as_stored);
    const BumpExperiment experiment =
        measure_bump(sample_of(field.heights), methods, untimed(field));
    const auto chosen = [&](double degrees, ErrorKind kind) {
        const BumpMeasurement* one = cheapest_within(experiment, {std::nullopt, degrees, kind});
        return one == nullptr ? std::nullopt : std::optional(one->method);
    };
    // Half a degree: 8 bits do, and a plain kernel.
    ASSERT_TRUE(chosen(0.5, ErrorKind::rms));
    EXPECT_EQ(chosen(0.5, ErrorKind::rms)->bits, 8);
    EXPECT_EQ(chosen(0.5, ErrorKind::rms)->arithmetic, Arithmetic::float32);
    // A hundredth: 16 bits and a kernel of higher order.
    ASSERT_TRUE(chosen(0.01, ErrorKind::rms));
    EXPECT_EQ(chosen(0.01, ErrorKind::rms)->bits, 16);
    EXPECT_EQ(chosen(0.01, ErrorKind::rms)->kernel, Kernel::central5);
    EXPECT_FALSE(chosen(1e-9, ErrorKind::max));
    // Every other within the bound costs as much or more, and every cheaper one is beyond it.
    for (const double bound : {3.0, 0.5, 0.1, 0.01, 1e-3, 1e-4}) {
        for (const ErrorKind kind : {ErrorKind::rms, ErrorKind::max}) {
            const BumpMeasurement* best = cheapest_within(experiment, {std::nullopt, bound, kind});
            for (const BumpMeasurement& one : experiment.measurements) {
                const double error = kind == ErrorKind::rms ? one.error.rms : one.error.max;
                const bool is_cheaper =
                    best == nullptr || nominal_cost(one.method) < nominal_cost(best->method);
                EXPECT_FALSE(is_cheaper && error <= bound);
            }
        }
    }
    EXPECT_EQ(most_accurate(experiment, ErrorKind::rms)->method.bits, 32);
}

TEST(BumpExperiment, TheExpectedErrorIsThatOfTheMapAndWhatIsAdded) {
    const BumpField field =
        make_bump_field({"", FieldShape::waves, 32.0, 0.3, FieldCoding::bits8, 1.0, 5}, 256, 256);
    const int radius = best_gaussian_radius(choose_kernel(field.heights, field.options));
    const auto methods = bump_methods(radius, std::array{8, 16}, both_arithmetics, as_stored);
    BumpExperimentOptions options = untimed(field);
    const BumpExperiment guess = measure_bump(sample_of(field.heights), methods, options);
    const BumpExperiment known = measure_bump(field, methods, options);
    EXPECT_GT(guess.reference.reference_degrees, 1.0);
    EXPECT_GT(guess.reference.reference_max_degrees, guess.reference.reference_degrees);
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const ExpectedError error = expected_error(guess.reference, guess.measurements[i]);
        EXPECT_EQ(error.map, guess.reference.reference_degrees);
        EXPECT_EQ(error.added, guess.measurements[i].error.rms);
        EXPECT_EQ(error.total(), std::hypot(error.map, error.added));
        const ExpectedError upper = expected_error_upper(guess.reference, guess.measurements[i]);
        EXPECT_GE(upper.map, error.map);
        EXPECT_EQ(upper.added, error.added);
        EXPECT_NEAR(error.total() / known.measurements[i].error.rms, 1.0, 0.3) << i;
    }
    // The added part of many is far below a limit that no total is within.
    const double limit = 0.5 * guess.reference.reference_degrees;
    EXPECT_EQ(cheapest_within(guess, {limit, std::nullopt, ErrorKind::rms}), nullptr);
    EXPECT_NE(cheapest_within(guess, {std::nullopt, limit, ErrorKind::rms}), nullptr);
    const BumpMeasurement* total = cheapest_within(
        guess, {1.5 * guess.reference.reference_degrees, std::nullopt, ErrorKind::rms});
    ASSERT_NE(total, nullptr);
    EXPECT_EQ(total->method.bits, 8);
    // What is not known is within no limit.
    BumpExperiment unknown = guess;
    unknown.reference.reference_degrees = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(cheapest_within(unknown, {90.0, std::nullopt, ErrorKind::rms}), nullptr);
}

TEST(BumpExperiment, TimesAreTakenInTurnsAndTheEfficientOnesAreMarked) {
    const BumpField field = field_of(FieldCoding::bits16);
    BumpExperimentOptions options = untimed(field);
    options.repeats = {3, 1};
    const auto methods = bump_methods(2, std::array{16}, both_arithmetics, as_stored);
    const BumpExperiment experiment = measure_bump(sample_of(field.heights), methods, options);
    int pareto_optimal = 0;
    for (const BumpMeasurement& one : experiment.measurements) {
        EXPECT_EQ(one.seconds.count, 3U);
        EXPECT_GT(one.megapixels_per_second, 0.0);
        pareto_optimal += one.is_pareto_optimal ? 1 : 0;
        for (const BumpMeasurement& other : experiment.measurements) {
            EXPECT_FALSE(one.is_pareto_optimal && other.error.rms < one.error.rms &&
                         other.seconds.median < one.seconds.median);
        }
    }
    EXPECT_GE(pareto_optimal, 1);
    EXPECT_LT(pareto_optimal, 20);
}

TEST(BumpExperiment, SmoothingIsTimedInEachRoundAndPartOfThoseThatWantIt) {
    const BumpField field = field_of(FieldCoding::bits8);
    BumpExperimentOptions options = untimed(field);
    options.repeats = {3, 1};
    const std::array methods = {BumpMethod{Kernel::sobel3, 2, Arithmetic::float32, 16, false},
                                BumpMethod{Kernel::sobel3, 2, Arithmetic::float32, 16, true},
                                BumpMethod{Kernel::central5, 2, Arithmetic::float64, 16, true}};
    const BumpExperiment known = measure_bump(field, methods, options);
    const BumpExperiment sampled = measure_bump(sample_of(field.heights), methods, options);
    for (const BumpExperiment* experiment : {&known, &sampled}) {
        const TimeStatistics& smoothing = experiment->smoothing;
        EXPECT_EQ(smoothing.count, 3U) << "once a round, not once a method; none while warming up";
        EXPECT_GT(smoothing.p10, 0.0);
        for (const BumpMeasurement& one : experiment->measurements) {
            EXPECT_EQ(one.seconds.count, 3U);
            if (!one.method.destaircased) continue;
            // What is longer in every round is so at every rank.
            EXPECT_GT(one.seconds.p10, smoothing.p10);
            EXPECT_GT(one.seconds.median, smoothing.median);
            EXPECT_GT(one.seconds.p90, smoothing.p90);
        }
    }
    const BumpExperiment plain = measure_bump(field, std::span(methods).first(1), options);
    EXPECT_EQ(plain.smoothing.count, 0U) << "nobody wants it";
    EXPECT_EQ(plain.measurements[0].seconds.count, 3U);
}

TEST(BumpExperiment, ALargeMapIsMeasuredOnPartsOfIt) {
    const BumpField field =
        make_bump_field({"", FieldShape::waves, 24.0, 0.3, FieldCoding::bits16, 0.0, 5}, 256, 256);
    BumpExperimentOptions options = untimed(field);
    const auto methods =
        bump_methods(2, std::array{16}, std::array{Arithmetic::float64}, as_stored);
    const BumpExperiment whole = measure_bump(sample_of(field.heights), methods, options);
    const BumpExperiment parts = measure_bump(sample_of(field.heights, 40000), methods, options);
    EXPECT_TRUE(whole.is_whole);
    EXPECT_FALSE(parts.is_whole);
    EXPECT_LE(parts.texels, 40000);
    for (std::size_t i = 0; i < methods.size(); ++i)
        EXPECT_NEAR(parts.measurements[i].error.rms / whole.measurements[i].error.rms, 1.0, 0.3);
}

TEST(BumpExperiment, CostsGrowWithDepthThenSmoothingThenOperations) {
    const BumpMethod plain{Kernel::central3, 2, Arithmetic::float32, 8, false};
    BumpMethod other = plain;
    other.arithmetic = Arithmetic::float64;
    EXPECT_GT(nominal_cost(other), nominal_cost(plain));
    other = plain;
    other.kernel = Kernel::scharr5;
    EXPECT_GT(nominal_cost(other), nominal_cost(plain));
    BumpMethod smooth = plain;
    smooth.destaircased = true;
    EXPECT_GT(nominal_cost(smooth), nominal_cost(other));
    BumpMethod deep = plain;
    deep.bits = 16;
    EXPECT_GT(nominal_cost(deep), nominal_cost(smooth));
}

}  // namespace
}  // namespace relief
