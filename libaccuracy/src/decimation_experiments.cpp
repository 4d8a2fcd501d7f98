// SPDX-License-Identifier: Apache-2.0
// Decimates analytic surfaces to the same number of triangles by different options, and measures
// the results at samples that are spread over the area against the surface in closed form.
#include "decimation_experiments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "experiment_parts.h"
#include "relief/mesh/topology.h"

namespace relief::accuracy::detail {

std::vector<TriangleSample> area_samples(const Mesh& mesh, std::size_t count) {
    std::vector<double> ends;  // The sum of the areas up to each triangle.
    double area = 0.0;
    const auto cross_of = [&](const glm::uvec3& t) {
        const glm::dvec3 a(mesh.positions[t.x]);
        return glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
    };
    for (const glm::uvec3& triangle : mesh.triangles) {
        area += glm::length(cross_of(triangle));
        ends.push_back(area);
    }
    std::vector<TriangleSample> samples;
    std::size_t t = 0;
    for (std::size_t i = 0; i < count && area > 0.0; ++i) {
        const auto number = static_cast<double>(i);
        const double place = (number + 0.5) / static_cast<double>(count) * area;
        while (t + 1 < ends.size() && ends[t] < place)
            ++t;
        // A low-discrepancy sequence on the triangle: the inverse powers of the root of x^3 = x
        // + 1.
        double b = number * 0.7548776662466927 + 0.5;
        double c = number * 0.5698402909980532 + 0.5;
        b -= std::floor(b);
        c -= std::floor(c);
        if (b + c > 1.0) {
            b = 1.0 - b;
            c = 1.0 - c;
        }
        const glm::uvec3& triangle = mesh.triangles[t];
        samples.push_back({(1.0 - b - c) * glm::dvec3(mesh.positions[triangle.x]) +
                               b * glm::dvec3(mesh.positions[triangle.y]) +
                               c * glm::dvec3(mesh.positions[triangle.z]),
                           cross_of(triangle)});
    }
    return samples;
}

ErrorStats surface_errors(const Mesh& mesh, AnalyticSurface surface, std::uint32_t seed,
                          DecimationError kind) {
    constexpr std::size_t count = 20'000;
    const auto nearest = nearest_on_surface(surface, seed);
    std::vector<float> errors;
    for (const TriangleSample& sample : area_samples(mesh, count)) {
        const ExactPoint exact = nearest(sample.position);
        const double error = kind == DecimationError::distance
                                 ? glm::length(sample.position - exact.position)
                                 : degrees_between(sample.normal, exact.normal);
        errors.push_back(static_cast<float>(error));
    }
    return error_stats(std::move(errors));
}

namespace {

constexpr std::uint32_t surface_seed = 1;
constexpr std::size_t usual_part = 16;  ///< Results have one of so many triangles.

/// A way to decimate.
struct DecimationMethod {
    std::string name;
    std::string options;  ///< Of relief-mesh decimate.
    bool has_attributes = true;
    double normal_weight = 0.0;
    double max_normal_degrees = 0.0;  ///< 0: no limit.
    bool keeps_seams = false;
    bool halves = false;  ///< By steps of a half, like levels of detail.
    bool keeps_positions = false;
};

std::vector<DecimationMethod> decimation_methods() {
    return {{.name = "positions", .options = "without attributes", .has_attributes = false},
            {.name = "default", .options = "none"},
            {.name = "normals 0.03", .options = "--weights normals=0.03", .normal_weight = 0.03},
            {.name = "normals 0.1", .options = "--weights normals=0.1", .normal_weight = 0.1},
            {.name = "normals 0.3", .options = "--weights normals=0.3", .normal_weight = 0.3},
            {.name = "within 30 degrees",
             .options = "--max-normal-error 30",
             .max_normal_degrees = 30.0},
            {.name = "keep seams", .options = "--keep-seams", .keeps_seams = true},
            {.name = "keep positions", .options = "--keep-positions", .keeps_positions = true},
            {.name = "by halves", .options = "relief-mesh lods", .halves = true}};
}

/// Decimates a mesh to a part of its triangles: one of `part`.
Mesh decimated_by(const DecimationMethod& method, const Mesh& mesh, std::size_t part) {
    DecimateOptions options;
    options.goal = DecimateGoal::distance;
    options.weights.normal = method.normal_weight;
    options.keep_seams = method.keeps_seams;
    options.fit_positions = !method.keeps_positions;
    if (method.max_normal_degrees > 0.0)
        options.max_normal_error = method.max_normal_degrees * std::numbers::pi / 180.0;
    const auto to = [&](const Mesh& finer, std::size_t divisor) {
        options.triangles = mesh.triangles.size() / divisor;
        return decimated(finer, options).mesh;
    };
    if (!method.has_attributes) {
        Mesh bare;
        bare.positions = mesh.positions;
        bare.triangles = mesh.triangles;
        return to(bare, part);
    }
    if (!method.halves) return to(mesh, part);
    Mesh level = to(mesh, 2);
    for (std::size_t divisor = 4; divisor <= part; divisor *= 2)
        level = to(level, divisor);
    return level;
}

/// An analytic surface as a mesh, which the methods of an experiment share.
struct DecimationInput {
    AnalyticSurface surface = AnalyticSurface::torus;
    Mesh mesh;

    DecimationInput(AnalyticSurface one, int cells)
        : surface(one),
          mesh(textured_mesh(one, Triangulation::jittered, TextureLayout::upright, cells,
                             surface_seed)
                   .mesh) {}
};

std::string unit_of(DecimationError kind) {
    return kind == DecimationError::angle ? "degrees" : "lengths";
}

/// The error over the number of triangles. In theory, the distance is inverse to that number, and
/// the angle to its root.
Chart triangles_chart(const DecimationInput& input, DecimationError kind, bool is_quick) {
    Chart chart{.id = "triangles",
                .title = "Fewer triangles",
                .x_label = "triangles of the result",
                .y_label = "RMS error, " + unit_of(kind)};
    const std::vector<std::size_t> parts = is_quick ? std::vector<std::size_t>{64, 16, 4}
                                                    : std::vector<std::size_t>{64, 32, 16, 8, 4, 2};
    for (const DecimationMethod& method : decimation_methods()) {
        if (method.max_normal_degrees > 0.0 || method.keeps_seams) continue;
        if (is_quick && method.normal_weight > 0.0) continue;
        Curve& curve = chart.curves.emplace_back(Curve{.method = method.name});
        for (const std::size_t part : parts) {
            const Mesh result = decimated_by(method, input.mesh, part);
            curve.points.push_back(
                {static_cast<double>(result.triangles.size()),
                 curve_error(surface_errors(result, input.surface, surface_seed, kind))});
        }
        fit(curve, kind == DecimationError::angle ? -0.5 : -1.0);
    }
    return chart;
}

PreparedExperiment decimation_of(AnalyticSurface surface, int cells, DecimationError kind) {
    const auto input = std::make_shared<const DecimationInput>(surface, cells);
    const std::size_t triangles = input->mesh.triangles.size();
    PreparedExperiment prepared;
    prepared.report = {
        .question = kind == DecimationError::angle
                        ? "Which options leave the triangles closest to the surface in direction?"
                        : "Which options leave the triangles closest to the surface?",
        .ground_truth =
            "The nearest point of the surface in closed form, and its normal, at "
            "samples that are spread over the area of the result. Tests verify it at "
            "points at known distances from the surface.",
        .input =
            fmt::format("{} of size 1 with a texture, jittered, {} x {} cells: {} to {} triangles",
                        name_of(surface), cells, cells, triangles, triangles / usual_part),
        .error_unit = unit_of(kind),
        .item = "triangle",
        .items = static_cast<double>(triangles)};
    const std::vector<DecimationMethod> methods = decimation_methods();
    for (std::size_t i = 0; i < methods.size(); ++i) {
        prepared.methods.push_back(
            {.name = methods[i].name,
             .choices = {{"options", methods[i].options}},
             .error =
                 [input, kind, method = methods[i]] {
                     const Mesh result = decimated_by(method, input->mesh, usual_part);
                     return MethodError(surface_errors(result, input->surface, surface_seed, kind),
                                        fmt::format("{} triangles", result.triangles.size()));
                 },
             .work = [input,
                      method = methods[i]] { decimated_by(method, input->mesh, usual_part); }});
    }
    prepared.costs.memory = false;
    return prepared;
}

PreparedExperiment decimation_case(AnalyticSurface surface, DecimationError kind, bool is_quick) {
    const int cells = is_quick ? 64 : 256;
    PreparedExperiment prepared = decimation_of(surface, cells, kind);
    prepared.finish = [surface, cells, kind, is_quick](Experiment& report) {
        report.charts = {triangles_chart(DecimationInput(surface, cells), kind, is_quick)};
    };
    return prepared;
}

PreparedExperiment decimation_of_large_mesh(bool is_quick) {
    PreparedExperiment prepared =
        decimation_of(AnalyticSurface::torus, is_quick ? 128 : 707, DecimationError::distance);
    prepared.report.question = "How much time and memory does the decimation of a large mesh cost?";
    prepared.costs.memory = true;
    // Two options are enough to see what attributes cost.
    std::erase_if(prepared.methods, [](const Method& method) {
        return method.name != "positions" && method.name != "default";
    });
    return prepared;
}

}  // namespace

std::vector<PlannedExperiment> decimation_plan(const PlanOptions& options) {
    using enum AnalyticSurface;
    const bool is_quick = options.is_quick;
    const std::vector<AnalyticSurface> surfaces =
        is_quick ? std::vector{torus, ellipsoid}
                 : std::vector<AnalyticSurface>(all_surfaces.begin(), all_surfaces.end());
    std::vector<PlannedExperiment> plan;
    for (const AnalyticSurface surface : surfaces) {
        for (const DecimationError kind : {DecimationError::distance, DecimationError::angle}) {
            const char* name = kind == DecimationError::angle ? "angle" : "distance";
            plan.push_back({fmt::format("decimation/{}-{}", name_of(surface), name),
                            Subject::decimation,
                            fmt::format("Decimation: {}, {}", name_of(surface), name),
                            [=] { return decimation_case(surface, kind, is_quick); }});
        }
    }
    plan.push_back({"decimation/large", Subject::decimation, "Decimation: a large mesh",
                    [is_quick] { return decimation_of_large_mesh(is_quick); }});
    return plan;
}

}  // namespace relief::accuracy::detail
