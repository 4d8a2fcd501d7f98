// SPDX-License-Identifier: Apache-2.0
// Plans and words; what is measured is in normal_methods.cpp. Tests:
// tests/accuracy/normals_experiments_test.cpp.
#include "normals/normals_experiments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analytic_words.h"
#include "measured_methods.h"
#include "normals/normal_methods.h"
#include "relief/accuracy/passes.h"

namespace relief {
namespace {

constexpr std::array float64_alone = {Arithmetic::float64};
constexpr std::uint32_t tables_seed = 1;
constexpr int cells_of_normal_tables = 64;  ///< As in docs/normals.md.

struct Case {
    AnalyticSurface surface;
    Triangulation triangulation;
};

std::string words_of(const Case& one) {
    return fmt::format("{}, {}", word_of(one.surface), word_of(one.triangulation));
}

std::vector<Case> cases(bool is_quick) {
    using enum AnalyticSurface;
    using enum Triangulation;
    if (is_quick) {
        return {{torus, regular},
                {sphere, jittered},
                {torus, jittered},
                {ellipsoid, anisotropic},
                {cubic, folded}};
    }
    std::vector<Case> all;
    for (const Triangulation triangulation : all_triangulations) {
        for (const AnalyticSurface surface : all_surfaces)
            all.push_back({surface, triangulation});
    }
    return all;
}

/// How an error depends on the number of cells: the exponent. On a regular grid whatever is on
/// opposite sides of a vertex cancels up to the second order; where points are jittered nothing
/// does, and the first stays. None where only rounding is left to see (Max's weights on spheres and
/// regular tori, area on a saddle cut regularly); where normals follow triangles turned over; and
/// for Max's weights on anisotropic cells, whose first order is so small that the second still
/// rules at these sizes.
std::optional<double> expected_order(const Case& one, const std::string& weighting) {
    using enum AnalyticSurface;
    const bool is_max = weighting == "max" || weighting == "auto";
    switch (one.triangulation) {
        case Triangulation::regular:
            if ((one.surface == sphere || one.surface == torus) && is_max) return std::nullopt;
            if (one.surface == saddle && weighting == "area") return std::nullopt;
            return -2.0;
        case Triangulation::jittered:
            return one.surface == sphere && is_max ? std::nullopt : std::optional(-1.0);
        case Triangulation::anisotropic:
            return is_max ? std::nullopt : std::optional(-1.0);
        default:
            return weighting == "area" || weighting == "auto" ? std::optional(-1.0) : std::nullopt;
    }
}

Chart cells_chart(const Case& one, bool is_quick) {
    Chart chart;
    chart.id = "cells";
    chart.title = "Finer cells";
    chart.x_label = "cells along each parameter";
    chart.y_label = "RMS error, degrees";
    std::vector<int> sizes = {16, 32, 64};
    // Anisotropic cells are 4 times as long: of 8, two would go around a sphere.
    if (one.triangulation != Triangulation::anisotropic) sizes.insert(sizes.begin(), 8);
    if (!is_quick) sizes.insert(sizes.end(), {128, 256});
    const std::vector<NormalMethod> methods = normal_methods(float64_alone);
    std::vector<std::vector<CurvePoint>> points(methods.size());
    for (const int cells : sizes) {
        const AnalyticMesh truth =
            analytic_mesh(one.surface, one.triangulation, cells, tables_seed);
        for (std::size_t m = 0; m < methods.size(); ++m) {
            const auto errors = normal_errors(methods[m].normals(truth.mesh), truth);
            points[m].push_back({static_cast<double>(cells), curve_error(errors)});
        }
    }
    for (std::size_t m = 0; m < methods.size(); ++m) {
        chart.curves.push_back(fitted_curve(methods[m].name(), std::move(points[m]),
                                            expected_order(one, methods[m].weighting)));
    }
    return chart;
}

/// "max, float64 is closest, 0.453 degrees RMS; area, float64 is farthest, 1.28."
std::string normals_finding(const Experiment& experiment) {
    const Measurement& best = *truest(experiment);
    const auto& all = experiment.measurements;
    const auto by_rms = [](const Measurement& a, const Measurement& b) {
        return a.error.rms < b.error.rms;
    };
    const Measurement& worst = *std::max_element(all.begin(), all.end(), by_rms);
    std::string text = fmt::format("{} is closest, {:.3g} degrees RMS; {} is farthest, {:.3g}.",
                                   value_of(best, "weighting"), best.error.rms,
                                   value_of(worst, "weighting"), worst.error.rms);
    double apart = 0.0;
    std::vector<double> ratios;
    for (const Measurement& in_double : all) {
        if (value_of(in_double, "arithmetic") != "float64") continue;
        for (const Measurement& in_float : all) {
            if (value_of(in_float, "arithmetic") != "float32" ||
                value_of(in_float, "weighting") != value_of(in_double, "weighting"))
                continue;
            apart = std::max(apart, std::abs(in_float.error.rms - in_double.error.rms));
            if (in_float.cost.one_thread)
                ratios.push_back(median_seconds(in_float) / median_seconds(in_double));
        }
    }
    text += fmt::format(" float32 changes no RMS by more than {:.2g} degrees", apart);
    if (!ratios.empty())
        text += fmt::format(" and takes {:.2f} times as long (median of the weightings)",
                            spread_of(ratios).median);
    return text + ".";
}

Experiment on_mesh(const std::string& id, const AnalyticMesh& truth, const std::string& input,
                   const CostChoice& costs, const RunOptions& options) {
    Experiment experiment;
    experiment.id = id;
    experiment.subject = Subject::normals;
    experiment.truth =
        "The surface's own normals in closed form, at its inner vertices before they were rounded "
        "to float; tests differentiate the surface numerically as well.";
    experiment.input = fmt::format("{}: {} triangles", input, truth.mesh.triangles.size());
    experiment.error_unit = "degrees";
    experiment.item = "triangle";
    experiment.items = static_cast<double>(truth.mesh.triangles.size());
    std::vector<MeasuredMethod> measured;
    for (const NormalMethod& method : normal_methods(both_arithmetics)) {
        measured.push_back({.name = method.name(),
                            .choices = method.choices(),
                            .error = figures_of(normal_errors(method.normals(truth.mesh), truth)),
                            .work = [normals = method.normals, &truth] { normals(truth.mesh); }});
    }
    measure_methods(measured, options, costs, experiment);
    experiment.finding = normals_finding(experiment);
    return experiment;
}

Experiment on_case(const Case& one, const RunOptions& options) {
    const AnalyticMesh truth =
        analytic_mesh(one.surface, one.triangulation, cells_of_normal_tables, tables_seed);
    Experiment experiment = on_mesh(
        fmt::format("normals/{}-{}", word_of(one.surface), word_of(one.triangulation)), truth,
        fmt::format("{}, {} x {} cells", words_of(one), cells_of_normal_tables,
                    cells_of_normal_tables),
        {.one_thread = true, .all_threads = true, .memory = false}, options);
    experiment.question = fmt::format(
        "Which weighting is closest to the normals of a surface ({}), and what does it cost?",
        words_of(one));
    experiment.charts.push_back(
        made_once(options, [&] { return cells_chart(one, options.is_quick); }));
    return experiment;
}

Experiment normals_on_large_mesh(const RunOptions& options) {
    const int cells = options.is_quick ? 160 : 512;
    const AnalyticMesh truth =
        analytic_mesh(AnalyticSurface::torus, Triangulation::jittered, cells, tables_seed);
    Experiment experiment =
        on_mesh("normals/large", truth, fmt::format("torus, jittered, {} x {} cells", cells, cells),
                {}, options);
    experiment.question = "What do normals of a large mesh cost, in time and in memory?";
    return experiment;
}

Experiment on_fans(const RunOptions& options) {
    const std::uint32_t fans = options.is_quick ? 2000 : 20000;
    constexpr int usual_valence = 6;
    Experiment experiment;
    experiment.id = "normals/fans";
    experiment.subject = Subject::normals;
    experiment.question =
        "How close is each weighting around a single vertex, by the number of its neighbours?";
    experiment.truth =
        "The normal of a random cubic at the origin, (0, 0, 1) by construction [Max 1999]; a test "
        "fits the cubic to its fan and differentiates it numerically.";
    experiment.input =
        fmt::format("{} fans of random cubic surfaces, {} neighbours each", fans, usual_valence);
    experiment.error_unit = "degrees";
    experiment.item = "fan";
    experiment.items = fans;
    Chart chart;
    chart.id = "neighbours";
    chart.title = "More neighbours";
    chart.x_label = "neighbours of the vertex";
    chart.is_x_log = false;
    chart.y_label = "RMS error, degrees";
    std::vector<MeasuredMethod> measured;
    for (const NormalMethod& method : normal_methods(float64_alone)) {
        std::vector<CurvePoint> points;
        for (int valence = 3; valence <= 9; ++valence) {
            const AngleDistribution errors = fan_errors(method, valence, fans);
            points.push_back({static_cast<double>(valence), curve_error(errors)});
            if (valence == usual_valence)
                measured.push_back({.name = method.name(),
                                    .choices = method.choices(),
                                    .error = figures_of(errors)});
        }
        chart.curves.emplace_back().method = method.name();
        chart.curves.back().points = std::move(points);
    }
    measure_methods(measured, options, {}, experiment);
    experiment.charts.push_back(std::move(chart));
    const Measurement& best = *truest(experiment);
    experiment.finding = fmt::format("With {} neighbours {} is closest, {:.3g} degrees RMS.",
                                     usual_valence, value_of(best, "weighting"), best.error.rms);
    return experiment;
}

}  // namespace

std::vector<PlannedExperiment> normals_plan(const RunOptions& options) {
    std::vector<PlannedExperiment> plan;
    for (const Case& one : cases(options.is_quick))
        plan.push_back(
            {"Normals: " + words_of(one), [&options, one] { return on_case(one, options); }});
    plan.push_back(
        {"Normals: a large mesh", [&options] { return normals_on_large_mesh(options); }});
    plan.push_back({"Normals: single fans", [&options] { return on_fans(options); }});
    return plan;
}

std::vector<Experiment> normals_experiments(const RunOptions& options) {
    return run_planned(normals_plan(options), options);
}

}  // namespace relief
