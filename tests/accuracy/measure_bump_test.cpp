// SPDX-License-Identifier: Apache-2.0
// The bump experiment: its reference fields, the convergence order of each kernel, and the choice
// of the cheapest method within an error limit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "experiment_parts.h"
#include "relief/accuracy/asset.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/report.h"
#include "support/images.h"

namespace relief {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

using testing::HasSubstr;

FieldRecipe recipe_of(FieldShape shape, FieldCoding coding = FieldCoding::float32,
                      double noise = 0.0) {
    return {"", shape, 40.0, 0.3, coding, noise, 9};
}

/// Returns the share of texels whose reference normal differs by more than `degrees` from finite
/// differences.
double share_beyond(double degrees, const BumpField& field) {
    const Image found = normals_by({Kernel::central7}, field.heights, field.options);
    const std::vector<float> angles = inner_angles(found, field.normals, 0);
    const auto beyond = std::ranges::count_if(
        angles, [&](float angle) { return static_cast<double>(angle) > degrees; });
    return static_cast<double>(beyond) / static_cast<double>(angles.size());
}

TEST(BumpFields, TheirNormalsAreThoseOfDifferencesOfHighOrder) {
    for (const FieldShape shape : {FieldShape::waves, FieldShape::mixed}) {
        EXPECT_EQ(share_beyond(2e-3, make_bump_field(recipe_of(shape), 160, 128)), 0.0);
    }
    // These fields have bends at rims, folds at ridges, or open borders. Finite differences are
    // wrong only there.
    EXPECT_EQ(share_beyond(0.5, make_bump_field(recipe_of(FieldShape::domes), 160, 128)), 0.0);
    EXPECT_LT(share_beyond(2e-3, make_bump_field(recipe_of(FieldShape::domes), 160, 128)), 0.35);
    EXPECT_LT(share_beyond(2e-3, make_bump_field(recipe_of(FieldShape::open), 160, 128)), 0.1);
    const double near_ridges = 1.0 - std::pow(1.0 - 12.0 / 40.0, 2) + 1e-12;
    EXPECT_LE(share_beyond(2e-3, make_bump_field(recipe_of(FieldShape::creases), 160, 160)),
              near_ridges);
    EXPECT_LT(share_beyond(2e-3, make_bump_field(recipe_of(FieldShape::terraces), 160, 160)), 0.5);
}

TEST(BumpFields, TerracesHaveNoNormalNextToWalls) {
    const BumpField field = make_bump_field(recipe_of(FieldShape::terraces), 160, 160);
    const std::span<const float> heights = field.heights.as<float>();
    std::size_t without = 0;
    for (std::size_t y = 0; y < 160; ++y) {
        for (std::size_t x = 0; x + 1 < 160; ++x) {
            const std::size_t i = y * 160 + x;
            // Walls are 1.2 texels high, and the ground rises by less than 0.9 per texel.
            if (std::abs(heights[i + 1] - heights[i]) > 0.9F) {
                EXPECT_TRUE(std::isnan(field.normals[i].x) && std::isnan(field.normals[i + 1].x));
            }
            without += std::isnan(field.normals[i].x) ? 1 : 0;
        }
    }
    EXPECT_GT(without, 300U);
    EXPECT_LT(without, 160U * 160U / 4U);
}

TEST(BumpFields, AreStoredAsTheySay) {
    const auto stored = [](FieldCoding coding) {
        return make_bump_field(recipe_of(FieldShape::waves, coding), 128, 128);
    };
    EXPECT_EQ(height_depth(stored(FieldCoding::float32).heights).bits, 0);
    EXPECT_EQ(height_depth(stored(FieldCoding::bits16).heights).bits, 16);
    EXPECT_EQ(height_depth(stored(FieldCoding::bits8).heights).bits, 8);
    const BumpField wide = stored(FieldCoding::bits8_in_16);
    EXPECT_EQ(wide.heights.bits(), 16);
    EXPECT_EQ(height_depth(wide.heights).bits, 8);
    EXPECT_EQ(wide.options.strength, stored(FieldCoding::bits8).options.strength);
    const BumpField dim = stored(FieldCoding::bits8_dim);
    const auto codes = dim.heights.as<std::uint8_t>();
    EXPECT_EQ((std::set<int>(codes.begin(), codes.end()).size()), 25U);
    EXPECT_EQ(*std::min_element(codes.begin(), codes.end()), 100);
    // 24 codes of 255 span the range of the float heights.
    EXPECT_NEAR(dim.options.strength * 24.0 / 255.0, wide.options.strength, 1e-9);
    const BumpField half = stored(FieldCoding::float16);
    for (const float height : half.heights.as<float>()) {
        int exponent = 0;
        const double times = std::frexp(static_cast<double>(height), &exponent) * 2048.0;
        ASSERT_EQ(times, std::round(times));
    }
}

TEST(BumpFields, NoiseAffectsHeightsButNotTheGroundTruth) {
    const BumpField clean = make_bump_field(recipe_of(FieldShape::waves), 128, 128);
    const BumpField noisy =
        make_bump_field(recipe_of(FieldShape::waves, FieldCoding::float32, 0.2), 128, 128);
    double squares = 0.0;
    for (std::size_t i = 0; i < clean.normals.size(); ++i) {
        const double noise = static_cast<double>(noisy.heights.as<float>()[i]) -
                             static_cast<double>(clean.heights.as<float>()[i]);
        squares += noise * noise;
        ASSERT_EQ(noisy.normals[i], clean.normals[i]);
    }
    EXPECT_NEAR(std::sqrt(squares / static_cast<double>(clean.normals.size())), 0.2, 0.003);
}

TEST(BumpFields, TheSetsHaveEveryShapeAndCodingAndAreApart) {
    std::set<std::string> names;
    std::set<std::uint32_t> seeds;
    for (const auto& set : {tuning_fields(), evaluation_fields()}) {
        std::set<FieldShape> shapes;
        std::set<FieldCoding> codings;
        int noisy = 0;
        for (const FieldRecipe& recipe : set) {
            EXPECT_TRUE(names.insert(recipe.name).second) << recipe.name;
            EXPECT_TRUE(seeds.insert(recipe.seed).second) << recipe.name;
            shapes.insert(recipe.shape);
            codings.insert(recipe.coding);
            noisy += recipe.noise > 0.0 ? 1 : 0;
        }
        EXPECT_EQ(shapes.size(), 6U);
        EXPECT_EQ(codings.size(), 6U);
        EXPECT_GE(noisy, 7);
    }
}

TEST(BumpFields, SizesThatDoNotFitAreRefused) {
    EXPECT_THROW(make_bump_field(recipe_of(FieldShape::waves), 7, 64), InvalidInput);
    const BumpField field = make_bump_field(recipe_of(FieldShape::waves), 16, 16);
    EXPECT_THROW(normal_error(make_image(16, 15, 3, 32, ColorSpace::data), field), InvalidInput);
}

constexpr int coarse_side = 96;
constexpr int border_margin = 8;  ///< No kernel of these tests reaches farther.

struct WaveError {
    double inside = 0.0;
    double border = 0.0;  ///< The error of the outermost texels only.
};

/// Returns the error on an oblique, clamped wave of slope 1, so that both axes have an error.
WaveError error_on(Kernel kernel, double wavelength) {
    const BumpField field = oblique_wave(coarse_side, wavelength, 32);
    const Image normals =
        normals_by({kernel, 2, Arithmetic::float64}, field.heights, field.options);
    const ErrorStats all = normal_error(normals, field, 0);
    const ErrorStats but_border = normal_error(normals, field, 1);
    const auto squares = [](const ErrorStats& error) {
        return error.rms * error.rms * static_cast<double>(error.count);
    };
    const auto of_border = static_cast<double>(all.count - but_border.count);
    return {normal_error(normals, field, border_margin).rms,
            std::sqrt((squares(all) - squares(but_border)) / of_border)};
}

TEST(BumpConvergence, EveryKernelHasItsOrderInsideAndFirstOrderAtAClampedBorder) {
    for (const EnumName<Kernel>& one : enum_names<Kernel>) {
        const Kernel kernel = one.value;
        const int order = gradient_kernel(kernel).order;
        // The wavelengths end where the rounding of heights to float shows: errors of order 6
        // decrease fast.
        const std::vector<double> wavelengths =
            order == 6   ? std::vector{9.0, 11.0, 13.0, 16.0, 19.0}
            : order == 4 ? std::vector{11.0, 14.0, 18.0, 23.0, 29.0}
                         : std::vector{20.0, 25.0, 31.0, 39.0, 48.0};
        std::vector<CurvePoint> inside;
        std::vector<CurvePoint> border;
        for (const double wavelength : wavelengths) {
            const WaveError error = error_on(kernel, wavelength);
            inside.push_back({wavelength, error.inside});
            border.push_back({wavelength, error.border});
        }
        EXPECT_NEAR(fitted_order(inside).value(), -order, 0.15 * order) << one.name;
        // The heights beyond the border are a reflection, whose curvature differs from that of the
        // wave.
        EXPECT_NEAR(fitted_order(border).value(), -1.0, 0.35) << one.name;
    }
}

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
    // The results equal those of direct measurements.
    EXPECT_NEAR(rms(Kernel::sobel3, Arithmetic::float64, 32), rms_error(field, Kernel::sobel3, 2),
                1e-6);
    // 8 bits of output cost a sixth of a degree, 16 bits 250 times less.
    EXPECT_NEAR(rms(Kernel::central7, Arithmetic::float64, 8), 0.18, 0.03);
    EXPECT_NEAR(rms(Kernel::central7, Arithmetic::float64, 16), 0.0007, 0.0002);
    EXPECT_LT(rms(Kernel::central7, Arithmetic::float64, 32), 2e-5);
    EXPECT_GT(rms(Kernel::sobel3, Arithmetic::float64, 32),
              100.0 * rms(Kernel::central5, Arithmetic::float64, 32));
}

TEST(BumpExperiment, ReferenceOfAMapIsTheMostAccurateMethod) {
    const BumpField field = field_of(FieldCoding::bits8);
    const auto methods = bump_methods(4, all_depths, both_arithmetics, both_ways);
    const BumpExperiment experiment =
        measure_bump(sample_of(field.heights), methods, untimed(field));
    ASSERT_TRUE(experiment.reference.method);
    EXPECT_TRUE(experiment.reference.method->destaircased);
    EXPECT_EQ(experiment.reference.method->arithmetic, Arithmetic::float64);
    EXPECT_GT(experiment.reference.error.rms, 0.01);
    EXPECT_THAT(experiment.reference.description, HasSubstr("after smoothing its steps"));
    // The result is more accurate than the choice for the unchanged map.
    const double of_plain =
        rms_error(field, experiment.choice.kernel, experiment.choice.gaussian_radius);
    const BumpExperiment known =
        measure_bump(field, std::array{*experiment.reference.method}, untimed(field));
    EXPECT_LT(known.measurements[0].error.rms, of_plain);
}

TEST(BumpExperiment, CheapestMethodWithinALimitIsSelected) {
    const BumpField field = field_of(FieldCoding::float32);
    const auto methods = bump_methods(4, all_depths, both_arithmetics, as_stored);
    const BumpExperiment experiment =
        measure_bump(sample_of(field.heights), methods, untimed(field));
    const auto chosen = [&](double degrees, ErrorKind kind) {
        const BumpMeasurement* one = cheapest_within(experiment, {std::nullopt, degrees, kind});
        return one == nullptr ? std::nullopt : std::optional(one->method);
    };
    // For half a degree, 8 bits and a simple kernel suffice.
    ASSERT_TRUE(chosen(0.5, ErrorKind::rms));
    EXPECT_EQ(chosen(0.5, ErrorKind::rms)->bits, 8);
    EXPECT_EQ(chosen(0.5, ErrorKind::rms)->arithmetic, Arithmetic::float32);
    // A hundredth of a degree needs 16 bits and a kernel of higher order.
    ASSERT_TRUE(chosen(0.01, ErrorKind::rms));
    EXPECT_EQ(chosen(0.01, ErrorKind::rms)->bits, 16);
    EXPECT_EQ(chosen(0.01, ErrorKind::rms)->kernel, Kernel::central5);
    EXPECT_FALSE(chosen(1e-9, ErrorKind::max));
    // Every other method within the limit costs at least as much, and every cheaper one is beyond
    // it.
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

TEST(BumpExperiment, ExpectedErrorCombinesMapAndConversion) {
    const BumpField field =
        make_bump_field({"", FieldShape::waves, 32.0, 0.3, FieldCoding::bits8, 1.0, 5}, 256, 256);
    const int radius = best_gaussian_radius(choose_kernel(field.heights, field.options));
    const auto methods = bump_methods(radius, std::array{8, 16}, both_arithmetics, as_stored);
    BumpExperimentOptions options = untimed(field);
    const BumpExperiment guess = measure_bump(sample_of(field.heights), methods, options);
    const BumpExperiment known = measure_bump(field, methods, options);
    EXPECT_GT(guess.reference.error.rms, 1.0);
    EXPECT_GT(guess.reference.error.max, guess.reference.error.rms);
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const ExpectedError error = expected_error(guess.reference, guess.measurements[i]);
        EXPECT_EQ(error.map, guess.reference.error.rms);
        EXPECT_EQ(error.added, guess.measurements[i].error.rms);
        EXPECT_EQ(error.total(), std::hypot(error.map, error.added));
        const ExpectedError upper = expected_error_upper(guess.reference, guess.measurements[i]);
        EXPECT_GE(upper.map, error.map);
        EXPECT_EQ(upper.added, error.added);
        EXPECT_NEAR(error.total() / known.measurements[i].error.rms, 1.0, 0.3) << i;
        for (const ErrorKind kind : {ErrorKind::mean, ErrorKind::p99}) {
            const ExpectedError other =
                expected_error(guess.reference, guess.measurements[i], kind);
            EXPECT_NEAR(other.total() / (known.measurements[i].error.*figure_of(kind)), 1.0, 0.35)
                << i << enum_name(kind);
            EXPECT_GE(expected_error_upper(guess.reference, guess.measurements[i], kind).total(),
                      other.total());
        }
    }
    // The added error of many methods is far below a limit that no total error meets.
    const double limit = 0.5 * guess.reference.error.rms;
    EXPECT_EQ(cheapest_within(guess, {limit, std::nullopt, ErrorKind::rms}), nullptr);
    EXPECT_NE(cheapest_within(guess, {std::nullopt, limit, ErrorKind::rms}), nullptr);
    const BumpMeasurement* total =
        cheapest_within(guess, {1.5 * guess.reference.error.rms, std::nullopt, ErrorKind::rms});
    ASSERT_NE(total, nullptr);
    EXPECT_EQ(total->method.bits, 8);
    // An unknown error is within no limit.
    BumpExperiment unknown = guess;
    unknown.reference.error.rms = std::numeric_limits<double>::quiet_NaN();
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
        // A method that is not Pareto-optimal can have a smaller median by chance, within a tie.
        for (const BumpMeasurement& other : experiment.measurements) {
            EXPECT_FALSE(one.is_pareto_optimal && other.is_pareto_optimal &&
                         other.error.rms < one.error.rms &&
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
            // A method that is slower in every round is slower at every percentile.
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
