// SPDX-License-Identifier: Apache-2.0
// Plans and words; what is measured is in tangent_methods.cpp. Tests:
// tests/accuracy/tangents_experiments_test.cpp.
#include "tangents/tangents_experiments.h"

#include <fmt/format.h>

#include <algorithm>

#include "measured_methods.h"
#include "relief/accuracy/passes.h"
#include "tangents/drawn_frames_experiment.h"
#include "tangents/tangent_methods.h"
#include "tangents/textured_cases.h"

namespace relief {
namespace {

constexpr int cells_of_tangent_tables = 64;  ///< As in docs/tangents.md.
constexpr const char* words_of_truth =
    "The surface's own frames in closed form, by which its image is laid on it; tests "
    "differentiate the surface numerically as well.";

/// The methods, the first also as many shaders read it, and what is best for any stored frame: the
/// surface's own, which leaves what interpolation errs.
std::vector<TangentMethod> shown_tangent_methods() {
    std::vector<TangentMethod> methods = tangent_methods();
    methods.insert(methods.begin() + 1, made_unit(methods.front()));
    return methods;
}

std::vector<std::pair<std::string, std::string>> choices_of(const TangentMethod& method) {
    const std::string frames = method.name.substr(0, method.name.find(','));
    switch (method.basis) {
        case ShaderBasis::made_unit:
            return {{"frames", frames}, {"shader", "made unit"}};
        case ShaderBasis::derived:
            return {{"frames", frames}, {"shader", "derived"}};
        default:
            return {{"frames", frames}, {"shader", "as interpolated"}};
    }
}

/// Normal and tangent and w as floats; without a tangent the normal alone.
double stored_bytes_of(const TangentMethod& method) {
    return method.tangents ? 28.0 : 12.0;
}

MeasuredMethod true_frames(const TexturedMesh& truth) {
    MeasuredMethod method;
    method.name = "surface's own";
    method.choices = {{"frames", "surface's own"}, {"shader", "as interpolated"}};
    method.error =
        figures_of(texel_errors(truth, true_tangents(truth), ShaderBasis::as_interpolated));
    method.stored_bytes = 28.0;
    method.note = "No method: true frames at the vertices. What is left is interpolation's.";
    return method;
}

std::vector<MeasuredMethod> measured_on(const TexturedMesh& truth) {
    std::vector<MeasuredMethod> measured = {true_frames(truth)};
    for (const TangentMethod& method : shown_tangent_methods()) {
        MeasuredMethod one;
        one.name = method.name;
        one.choices = choices_of(method);
        one.error = figures_of(texel_errors(truth, method.tangents_of(truth.mesh), method.basis));
        one.stored_bytes = stored_bytes_of(method);
        if (method.tangents)
            one.work = [tangents = method.tangents, &truth] { tangents(truth.mesh); };
        else
            one.note =
                "Nothing to compute for the mesh: shaders derive frames for each pixel. What that "
                "takes, tangents/drawn measures.";
        measured.push_back(std::move(one));
    }
    return measured;
}

/// How an error depends on the number of cells: the exponent that it comes to. Single triangles err
/// by the first order; averages of them by the second where opposite ones cancel and else by the
/// first, which on coarse cells interpolation's own second order still outweighs. None for
/// anisotropic cells, on which it does so at all of these sizes.
std::optional<double> expected_order(const TexturedCase& one, const TangentMethod& method) {
    if (one.id.find("anisotropic") != std::string::npos) return std::nullopt;
    return one.id.find("regular") != std::string::npos && method.tangents ? -2.0 : -1.0;
}

/// Errors of all methods on meshes that vary.
Chart chart_over(const std::vector<std::pair<double, TexturedMesh>>& meshes) {
    Chart chart;
    chart.y_label = "RMS error, degrees";
    for (const TangentMethod& method : shown_tangent_methods()) {
        Curve& curve = chart.curves.emplace_back();
        curve.method = method.name;
        for (const auto& [x, truth] : meshes) {
            const CornerTangents tangents = method.tangents_of(truth.mesh);
            curve.points.push_back({x, curve_error(texel_errors(truth, tangents, method.basis))});
        }
    }
    return chart;
}

Chart cells_chart(const TexturedCase& one, bool is_quick) {
    std::vector<std::pair<double, TexturedMesh>> meshes;
    for (const int cells : is_quick ? std::vector{16, 32, 64} : std::vector{16, 32, 64, 128})
        meshes.emplace_back(cells, one.mesh(cells));
    Chart chart = chart_over(meshes);
    chart.id = "cells";
    chart.title = "Finer cells";
    chart.x_label = "cells along each parameter";
    const std::vector<TangentMethod> methods = shown_tangent_methods();
    for (std::size_t m = 0; m < methods.size(); ++m) {
        Curve& curve = chart.curves[m];
        curve = fitted_curve(curve.method, curve.points, expected_order(one, methods[m]));
    }
    return chart;
}

Chart bevels_chart() {
    std::vector<std::pair<double, TexturedMesh>> meshes;
    for (const double width : {0.01, 0.02, 0.05, 0.1, 0.2, 0.5})
        meshes.emplace_back(width, bevelled_plate(width));
    Chart chart = chart_over(meshes);
    chart.id = "bevels";
    chart.title = "Wider bevels";
    chart.x_label = "width of the bevels, half the plate's being 1";
    return chart;
}

/// "mikktspace is closest of those stored, ...; frames that shaders derive are ... off."
std::string tangents_finding(const Experiment& experiment) {
    const Measurement* best = nullptr;
    const Measurement* derived = nullptr;
    for (const Measurement& one : experiment.measurements) {
        if (value_of(one, "frames") == "surface's own") continue;
        if (value_of(one, "shader") == "derived") derived = &one;
        if (value_of(one, "shader") != "as interpolated") continue;
        if (best == nullptr || one.error.rms < best->error.rms) best = &one;
    }
    return fmt::format(
        "Of stored frames {} is closest, {:.3g} degrees RMS, where the surface's own would leave "
        "{:.3g}; frames derived in the shader are {:.3g} off.",
        best->method, best->error.rms, experiment.measurements.front().error.rms,
        derived->error.rms);
}

Experiment on_mesh(const std::string& id, const std::string& input, const TexturedMesh& truth,
                   const CostChoice& costs, const RunOptions& options) {
    Experiment experiment;
    experiment.id = id;
    experiment.subject = Subject::tangents;
    experiment.truth = words_of_truth;
    experiment.input = fmt::format("{}: {} triangles", input, truth.mesh.triangles.size());
    experiment.error_unit = "degrees";
    experiment.item = "triangle";
    experiment.items = static_cast<double>(truth.mesh.triangles.size());
    measure_methods(measured_on(truth), options, costs, experiment);
    experiment.finding = tangents_finding(experiment);
    return experiment;
}

Experiment on_case(const TexturedCase& one, const RunOptions& options) {
    const TexturedMesh truth = one.mesh(cells_of_tangent_tables);
    const std::string input = one.has_cells
                                  ? fmt::format("{}, {} x {} cells", one.name,
                                                cells_of_tangent_tables, cells_of_tangent_tables)
                                  : one.name;
    Experiment experiment =
        on_mesh("tangents/" + one.id, input, truth,
                {.one_thread = true, .all_threads = true, .memory = false}, options);
    experiment.question = fmt::format(
        "Where does a texel tilted by 30 degrees point, by each way of getting frames ({})?",
        one.name);
    experiment.charts.push_back(made_once(options, [&] {
        return one.has_cells ? cells_chart(one, options.is_quick) : bevels_chart();
    }));
    return experiment;
}

Experiment tangents_on_large_mesh(const RunOptions& options) {
    const int cells = options.is_quick ? 128 : 400;
    const TexturedMesh truth = textured_mesh(AnalyticSurface::torus, Triangulation::jittered,
                                             TextureLayout::upright, cells, 1);
    Experiment experiment =
        on_mesh("tangents/large", fmt::format("torus, jittered, {} x {} cells", cells, cells),
                truth, {}, options);
    experiment.question = "What do tangents of a large mesh cost, in time and in memory?";
    return experiment;
}

Experiment mismatches(const RunOptions& options) {
    const TexturedMesh truth =
        textured_mesh(AnalyticSurface::torus, Triangulation::jittered, TextureLayout::upright,
                      options.is_quick ? 32 : cells_of_tangent_tables, 1);
    Experiment experiment;
    experiment.id = "tangents/mismatch";
    experiment.subject = Subject::tangents;
    experiment.question = "What does a map show that is baked in one basis and read in another?";
    experiment.truth = "The normal that was baked: in a basis of its own it comes back exactly.";
    experiment.input =
        fmt::format("normals tilted by 30 degrees on a jittered torus of {} triangles",
                    truth.mesh.triangles.size());
    experiment.error_unit = "degrees";
    experiment.item = "triangle";
    experiment.items = static_cast<double>(truth.mesh.triangles.size());
    std::vector<MeasuredMethod> measured;
    for (const TangentMethod& baker : shown_tangent_methods()) {
        for (const TangentMethod& reader : shown_tangent_methods()) {
            measured.push_back(
                {.name = fmt::format("baked in {}, read in {}", baker.name, reader.name),
                 .choices = {{"baked in", baker.name}, {"read in", reader.name}},
                 .error = figures_of(mismatch_errors(truth, baker, reader))});
        }
    }
    measure_methods(measured, options, {}, experiment);
    const auto by_rms = [](const Measurement& a, const Measurement& b) {
        return a.error.rms < b.error.rms;
    };
    const auto& all = experiment.measurements;
    const Measurement& worst = *std::max_element(all.begin(), all.end(), by_rms);
    experiment.finding = fmt::format(
        "A map read in its own basis is exact to {:.1g} degrees; the worst pair is off by {:.3g} "
        "RMS, {:.3g} at most: {}.",
        truest(experiment)->error.rms, worst.error.rms, worst.error.max, worst.method);
    return experiment;
}

bool is_quick_one(const TexturedCase& one) {
    for (const char* id : {"torus-regular", "torus-jittered", "cubic-anisotropic",
                           "torus-jittered-mirrored", "plate"}) {
        if (one.id == id) return true;
    }
    return false;
}

}  // namespace

std::vector<PlannedExperiment> tangents_plan(const RunOptions& options) {
    std::vector<PlannedExperiment> plan;
    for (const TexturedCase& one : textured_cases()) {
        if (options.is_quick && !is_quick_one(one)) continue;
        plan.push_back(
            {"Tangents: " + one.name, [&options, one] { return on_case(one, options); }});
    }
    plan.push_back(
        {"Tangents: a large mesh", [&options] { return tangents_on_large_mesh(options); }});
    plan.push_back({"Tangents: bases that differ", [&options] { return mismatches(options); }});
    plan.push_back({"Tangents: frames stored and derived, drawn",
                    [&options] { return drawn_frames_experiment(Drawing(), options); }});
    return plan;
}

std::vector<Experiment> tangents_experiments(const RunOptions& options) {
    return run_planned(tangents_plan(options), options);
}

}  // namespace relief
