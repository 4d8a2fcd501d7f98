// SPDX-License-Identifier: Apache-2.0
// Computes the angular error of every weighting on analytic surfaces, where normals are known in
// closed form, with the convergence order over the cell size.
#include "experiment_parts.h"

#include <fmt/format.h>

#include <memory>

#include "experiment_driver.h"
#include "relief/mesh/statistics.h"

namespace relief::accuracy::detail {

std::vector<NormalWeighting> normal_weightings() {
    std::vector<NormalWeighting> weightings;
    for (const EnumName<NormalWeight>& one : enum_names<NormalWeight>)
        weightings.push_back({one.name, one.value});
    weightings.push_back({"auto", std::nullopt});
    return weightings;
}

std::vector<glm::vec3> normals_by(std::optional<NormalWeight> weight, Arithmetic arithmetic,
                                  const Mesh& mesh) {
    Report report;
    NormalOptions options;
    options.arithmetic = arithmetic;
    if (!weight) return chosen_normals(mesh.positions, mesh.triangles, options, report).normals;
    options.weight = *weight;
    return vertex_normals(mesh.positions, mesh.triangles, options, report);
}

std::vector<NormalMethod> normal_methods(std::span<const Arithmetic> arithmetics) {
    std::vector<NormalMethod> methods;
    for (const NormalWeighting& weighting : normal_weightings()) {
        for (const Arithmetic arithmetic : arithmetics) {
            const char* const word = enum_name(arithmetic);
            methods.push_back({fmt::format("{}, {}", weighting.name, word),
                               {{"weighting", weighting.name}, {"arithmetic", word}},
                               [weight = weighting.value, arithmetic](const Mesh& mesh) {
                                   return normals_by(weight, arithmetic, mesh);
                               }});
        }
    }
    return methods;
}

ErrorStats normal_errors(std::span<const glm::vec3> normals, const AnalyticMesh& ground_truth) {
    std::vector<float> degrees;
    for (std::size_t v = 0; v < normals.size(); ++v) {
        if (ground_truth.inner[v] == 0) continue;
        degrees.push_back(angle_of(glm::dvec3(normals[v]), ground_truth.normals[v]));
    }
    return error_stats(std::move(degrees));
}

ErrorStats fan_errors(const NormalMethod& method, int valence, std::uint32_t fans) {
    constexpr glm::dvec3 up(0.0, 0.0, 1.0);
    std::vector<float> degrees;
    for (std::uint32_t seed = 0; seed < fans; ++seed) {
        const std::vector<glm::vec3> normals = method.compute(cubic_fan(valence, seed));
        degrees.push_back(angle_of(glm::dvec3(normals.front()), up));
    }
    return error_stats(std::move(degrees));
}

namespace {

constexpr std::array float64_alone = {Arithmetic::float64};
constexpr std::uint32_t tables_seed = 1;
constexpr int cells_of_normal_tables = 64;  ///< The same number as in docs/normals.md.

struct Case {
    AnalyticSurface surface;
    Triangulation triangulation;
};

using relief::accuracy::detail::name_of;

std::string name_of(const Case& one) {
    return fmt::format("{}, {}", name_of(one.surface), name_of(one.triangulation));
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

/// The expected exponent of the error over the number of cells. On a regular grid, contributions
/// from opposite sides of a vertex cancel up to the second order. With jittered vertices the first
/// order stays. There is no expectation if only rounding remains (Max's weights on spheres and
/// regular tori, area on a regular saddle), if normals follow flipped triangles, and for Max's
/// weights on anisotropic cells, whose first order is so small that the second order dominates at
/// these sizes.
std::optional<double> expected_order(const Case& one, const NormalMethod& method) {
    using enum AnalyticSurface;
    const std::string& weighting = method.choices.front().second;
    // The automatic choice takes Max's weights, except on folded triangles.
    const bool is_max = weighting == "auto" || weighting == "max";
    const bool is_area = weighting == "area";
    switch (one.triangulation) {
        case Triangulation::regular:
            if ((one.surface == sphere || one.surface == torus) && is_max) return std::nullopt;
            if (one.surface == saddle && is_area) return std::nullopt;
            return -2.0;
        case Triangulation::jittered:
            return one.surface == sphere && is_max ? std::nullopt : std::optional(-1.0);
        case Triangulation::anisotropic:
            return is_max ? std::nullopt : std::optional(-1.0);
        default:
            return is_area || weighting == "auto" ? std::optional(-1.0) : std::nullopt;
    }
}

Chart cells_chart(const Case& one, bool is_quick) {
    std::vector<double> sizes = {16, 32, 64};
    // Anisotropic cells are 4 times as long, so 8 cells would leave two around a sphere.
    if (one.triangulation != Triangulation::anisotropic) sizes.insert(sizes.begin(), 8);
    if (!is_quick) sizes.insert(sizes.end(), {128, 256});
    const std::vector<NormalMethod> methods = normal_methods(float64_alone);
    Chart chart = chart_over(
        {.id = "cells",
         .title = "Finer cells",
         .x_label = "cells along each parameter",
         .y_label = "RMS error, degrees"},
        names_of(methods), sizes,
        [&](double cells) {
            return analytic_mesh(one.surface, one.triangulation, static_cast<int>(cells),
                                 tables_seed);
        },
        [&](std::size_t i, const AnalyticMesh& ground_truth) {
            return curve_error(normal_errors(methods[i].compute(ground_truth.mesh), ground_truth));
        });
    for (std::size_t i = 0; i < methods.size(); ++i)
        fit(chart.curves[i], expected_order(one, methods[i]));
    return chart;
}

/// The weightings in both arithmetics on a mesh. \param input  describes the mesh
PreparedExperiment on_mesh(AnalyticMesh mesh, const std::string& input) {
    const auto ground_truth = std::make_shared<const AnalyticMesh>(std::move(mesh));
    const auto triangles = static_cast<double>(ground_truth->mesh.triangles.size());
    PreparedExperiment prepared;
    prepared.report = {
        .ground_truth =
            "The exact normals of the surface in closed form, at its inner vertices before "
            "rounding to float. Tests verify them by numerical differentiation of the surface.",
        .input = fmt::format("{}: {} triangles", input, triangles),
        .error_unit = "degrees",
        .item = "triangle",
        .items = triangles};
    prepared.methods =
        methods_on(std::shared_ptr<const Mesh>(ground_truth, &ground_truth->mesh),
                   normal_methods(both_arithmetics), [ground_truth](const NormalMethod& method) {
                       return normal_errors(method.compute(ground_truth->mesh), *ground_truth);
                   });
    return prepared;
}

PreparedExperiment on_case(const Case& one, const PlanOptions& options) {
    PreparedExperiment prepared =
        on_mesh(analytic_mesh(one.surface, one.triangulation, cells_of_normal_tables, tables_seed),
                fmt::format("{}, {} x {} cells", name_of(one), cells_of_normal_tables,
                            cells_of_normal_tables));
    prepared.report.question = fmt::format(
        "Which weighting has the smallest error on this surface ({}), and what does it cost?",
        name_of(one));
    prepared.costs.memory = false;
    prepared.finish = [one, is_quick = options.is_quick](Experiment& report) {
        report.charts = {cells_chart(one, is_quick)};
    };
    return prepared;
}

PreparedExperiment normals_on_large_mesh(const PlanOptions& options) {
    const int cells = options.is_quick ? 160 : 512;
    PreparedExperiment prepared =
        on_mesh(analytic_mesh(AnalyticSurface::torus, Triangulation::jittered, cells, tables_seed),
                fmt::format("torus, jittered, {} x {} cells", cells, cells));
    prepared.report.question = "How much time and memory do the normals of a large mesh cost?";
    return prepared;
}

constexpr int usual_valence = 6;

/// The error over the number of neighbors. \param experiment  has measured the usual number
Chart neighbors_chart(const Experiment& experiment, const std::vector<NormalMethod>& methods,
                      std::uint32_t fans) {
    return chart_over(
        {.id = "neighbours",
         .title = "More neighbors",
         .x_label = "neighbors of the vertex",
         .y_label = "RMS error, degrees",
         .is_x_log = false},
        names_of(methods), {3, 4, 5, 6, 7, 8, 9},
        [](double valence) { return static_cast<int>(valence); },
        [&](std::size_t i, int valence) {
            return curve_error(valence == usual_valence ? experiment.measurements.at(i).error
                                                        : fan_errors(methods[i], valence, fans));
        });
}

PreparedExperiment on_fans(const PlanOptions& options) {
    const std::uint32_t fans = options.is_quick ? 2000 : 20000;
    const std::vector<NormalMethod> methods = normal_methods(float64_alone);
    PreparedExperiment prepared;
    prepared.report = {
        .question =
            "What is the error of each weighting at a single vertex, by its number of neighbors?",
        .ground_truth =
            "The normal of a random cubic surface at the origin, (0, 0, 1) by construction [Max "
            "1999]. A test verifies it by fitting the cubic to its fan and differentiating it "
            "numerically.",
        .input =
            fmt::format("{} fans of random cubic surfaces, {} neighbors each", fans, usual_valence),
        .error_unit = "degrees",
        .item = "fan",
        .items = static_cast<double>(fans)};
    for (const NormalMethod& one : methods) {
        prepared.methods.push_back({.name = one.name, .choices = one.choices, .error = [one, fans] {
                                        return fan_errors(one, usual_valence, fans);
                                    }});
    }
    prepared.finish = [methods, fans](Experiment& report) {
        report.charts = {neighbors_chart(report, methods, fans)};
    };
    return prepared;
}

}  // namespace

std::vector<PlannedExperiment> normals_plan(const PlanOptions& options) {
    std::vector<PlannedExperiment> plan;
    for (const Case& one : cases(options.is_quick)) {
        plan.push_back(
            {fmt::format("normals/{}-{}", name_of(one.surface), name_of(one.triangulation)),
             "Normals: " + name_of(one),
             [one](const PlanOptions& all) { return on_case(one, all); }});
    }
    plan.push_back({"normals/large", "Normals: a large mesh", normals_on_large_mesh});
    plan.push_back({"normals/fans", "Normals: single fans", on_fans});
    return plan;
}

}  // namespace relief::accuracy::detail
