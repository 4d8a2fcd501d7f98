// SPDX-License-Identifier: Apache-2.0
// The results of all experiments that do not draw with OpenGL: they are complete, fall at the order
// of theory, and every statistic and every point of a curve is that of quick_figures.tsv.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <span>
#include <vector>

#include "experiment_checks.h"
#include "experiment_parts.h"
#include "figure_table.h"
#include "relief/mesh/statistics.h"
#include "support/labels.h"

namespace relief::test {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

FILE_LABELS(not_sanitized);

bool is_textbook(const std::string& method) {
    return method.starts_with("plain");
}

/// On coarse meshes a term of higher order may dominate. Then the errors fall faster than in
/// theory, but less so on the finest meshes.
void expect_order(const Curve& curve) {
    const std::vector<CurvePoint> finest(curve.points.end() - 2, curve.points.end());
    const double expected = *curve.expected_order;
    const bool approaches =
        *curve.order < expected && fitted_order(finest).value_or(*curve.order) > *curve.order;
    EXPECT_TRUE(std::abs(*curve.order - expected) < 0.35 || approaches)
        << *curve.order << ", not " << expected;
}

void expect_theory(const Experiment& experiment) {
    for (const Chart& chart : experiment.charts) {
        for (const Curve& curve : chart.curves) {
            SCOPED_TRACE(experiment.id + ", " + chart.id + ": " + curve.method);
            if (curve.expected_order && curve.order) expect_order(curve);
            // Scale and steepness change no result of the library.
            if (experiment.id.ends_with("-scale") || experiment.id.ends_with("-steepness")) {
                EXPECT_TRUE(is_textbook(curve.method) || !curve.breaks_at);
            }
        }
    }
}

/// Returns the figures of an experiment by method, and by "CHART: METHOD".
FigureTable::Figures figures_of(const Experiment& experiment) {
    FigureTable::Figures figures;
    for (const Measurement& one : experiment.measurements) {
        const ErrorStats& error = one.error;
        figures[one.method] = {static_cast<double>(error.count),
                               static_cast<double>(error.undefined),
                               error.rms,
                               error.mean,
                               error.p99,
                               error.max,
                               one.cost.stored_bytes};
    }
    for (const Chart& chart : experiment.charts) {
        for (const Curve& curve : chart.curves) {
            for (const CurvePoint& point : curve.points)
                figures[chart.id + ": " + curve.method].push_back(point.error);
        }
    }
    return figures;
}

/// Another order of summation changes less than five digits, and rounding errors themselves.
bool is_equal(double a, double b) {
    return (std::isnan(a) && std::isnan(b)) || std::abs(a - b) <= 5e-5 * std::abs(b) + 1e-7;
}

/// Expects the heat maps and the pictures of bakes to show the measured errors.
void expect_pictures_of_errors(const std::vector<Experiment>& all) {
    for (const Experiment& one : all) {
        ASSERT_EQ(one.heat_maps.size(), 3U) << one.id;
        for (const HeatMap& map : one.heat_maps) {
            EXPECT_EQ(map.errors.width, 128);
            EXPECT_EQ(map.errors.height, 128);
            const double rms = measurement_of(one, map.method).error.rms;
            const std::span<const float> errors = map.errors.as<float>();
            EXPECT_NEAR(error_stats({errors.begin(), errors.end()}).rms, rms, 1e-4 * rms)
                << map.method;
        }
    }
    ASSERT_EQ(all.front().pictures.size(), 2U);
    for (const PicturePair& pair : all.front().pictures) {
        const double off = picture_error(to_linear(pair.after), pair.before).figures.rms;
        EXPECT_LT(off, 0.15) << pair.before_label;
        EXPECT_GT(off, 0.01) << "outlines differ: " << pair.before_label;
    }
}

class ExperimentsOf : public testing::TestWithParam<EnumName<Subject>> {};

TEST_P(ExperimentsOf, HaveTheStoredFigures) {
    RunOptions options = quick_untimed();
    options.selects_experiment = [](const std::string& id) {
        return !id.ends_with("drawn") &&
               (!id.starts_with("shading/") || id.starts_with("shading/fresnel") ||
                id == "shading/unit-normal");
    };
    std::vector<Experiment> all = run_experiments(std::array{GetParam().value}, options);
    const FigureTable stored;
    FigureTable actual = stored;
    for (const Experiment& experiment : all) {
        expect_theory(experiment);
        const FigureTable::Figures figures = figures_of(experiment);
        actual.experiments[experiment.id] = {experiment.input, figures};
        const auto expected = stored.experiments.find(experiment.id);
        ASSERT_NE(expected, stored.experiments.end()) << experiment.id;
        EXPECT_EQ(expected->second.input, experiment.input);
        EXPECT_EQ(expected->second.figures.size(), figures.size()) << experiment.id;
        for (const auto& [method, values] : expected->second.figures) {
            const auto found = figures.find(method);
            EXPECT_TRUE(found != figures.end() &&
                        std::equal(values.begin(), values.end(), found->second.begin(),
                                   found->second.end(), is_equal))
                << experiment.id << ": " << method;
        }
    }
    if (HasFailure()) {
        const std::filesystem::path file =
            std::filesystem::path(testing::TempDir()) / FigureTable::name;
        actual.write(file);
        ADD_FAILURE() << "if the changes are right, replace tests/accuracy/" << FigureTable::name
                      << " by " << file;
    }
    if (GetParam().value == Subject::bake) expect_pictures_of_errors(all);
    // Only textbook code has undefined results.
    for (Experiment& experiment : all) {
        std::erase_if(experiment.measurements,
                      [](const Measurement& one) { return is_textbook(one.method); });
    }
    expect_whole(all, GetParam().value);
}

INSTANTIATE_TEST_SUITE_P(All, ExperimentsOf, testing::ValuesIn(enum_names<Subject>),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace relief::test
