// SPDX-License-Identifier: Apache-2.0
// Decimates analytic surfaces to the same number of triangles by different options, and measures
// the results at samples that are spread over the area against the surface in closed form.
#include "experiment_parts.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

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
        samples.push_back({t,
                           (1.0 - b - c) * glm::dvec3(mesh.positions[triangle.x]) +
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

/// An analytic surface as a mesh, and the part of its triangles that a result has: one of `part`.
struct DecimationInput {
    AnalyticSurface surface = AnalyticSurface::torus;
    Mesh mesh;
    std::size_t part = usual_part;

    DecimationInput(AnalyticSurface one, int cells)
        : surface(one),
          mesh(textured_mesh(one, Triangulation::jittered, TextureLayout::upright, cells,
                             surface_seed)
                   .mesh) {}
};

/// A way to decimate. Its choice is the option of relief-mesh decimate.
using DecimationMethod = MethodOn<DecimationInput, Mesh>;

Mesh reduced(const Mesh& mesh, DecimateOptions options, std::size_t triangles) {
    options.goal = DecimateGoal::distance;
    options.triangles = triangles;
    return decimated(mesh, options).mesh;
}

std::vector<DecimationMethod> decimation_methods() {
    std::vector<DecimationMethod> methods;
    DecimateOptions usual;
    usual.weights.normal = 0.0;
    usual.fit_positions = true;
    const auto add = [&](const std::string& name, const std::string& option, const auto& change) {
        DecimateOptions options = usual;
        change(options);
        methods.push_back({name, {{"options", option}}, [options](const DecimationInput& input) {
                               return reduced(input.mesh, options,
                                              input.mesh.triangles.size() / input.part);
                           }});
    };
    methods.push_back(
        {"positions", {{"options", "without attributes"}}, [usual](const DecimationInput& input) {
             Mesh bare;
             bare.positions = input.mesh.positions;
             bare.triangles = input.mesh.triangles;
             return reduced(bare, usual, bare.triangles.size() / input.part);
         }});
    add("default", "none", [](DecimateOptions&) {});
    for (const double weight : {0.03, 0.1, 0.3}) {
        add(fmt::format("normals {}", weight), fmt::format("--weights normals={}", weight),
            [&](DecimateOptions& options) { options.weights.normal = weight; });
    }
    add("within 30 degrees", "--max-normal-error 30", [](DecimateOptions& options) {
        options.max_normal_error = 30.0 * std::numbers::pi / 180.0;
    });
    add("keep seams", "--keep-seams", [](DecimateOptions& options) { options.keep_seams = true; });
    add("keep positions", "--keep-positions",
        [](DecimateOptions& options) { options.fit_positions = false; });
    methods.push_back(
        {"by halves", {{"options", "relief-mesh lods"}}, [usual](const DecimationInput& input) {
             const std::size_t triangles = input.mesh.triangles.size();
             Mesh level = reduced(input.mesh, usual, triangles / 2);
             for (std::size_t divisor = 4; divisor <= input.part; divisor *= 2)
                 level = reduced(level, usual, triangles / divisor);
             return level;
         }});
    return methods;
}

std::string unit_of(DecimationError kind) {
    return kind == DecimationError::angle ? "degrees" : "lengths";
}

/// The error over the number of triangles. In theory, the distance is inverse to that number, and
/// the angle to its root.
Chart triangles_chart(DecimationInput input, DecimationError kind, bool is_quick) {
    Chart chart{.id = "triangles",
                .title = "Fewer triangles",
                .x_label = "triangles of the result",
                .y_label = "RMS error, " + unit_of(kind)};
    const std::vector<std::size_t> parts = is_quick ? std::vector<std::size_t>{64, 16, 4}
                                                    : std::vector<std::size_t>{64, 32, 16, 8, 4, 2};
    for (const DecimationMethod& method : decimation_methods()) {
        const std::string& name = method.name;
        if (name == "within 30 degrees" || name == "keep seams") continue;
        if (is_quick && name.starts_with("normals")) continue;
        Curve& curve = chart.curves.emplace_back(Curve{.method = name});
        for (const std::size_t part : parts) {
            input.part = part;
            const Mesh result = method.compute(input);
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
    prepared.methods =
        methods_on(input, decimation_methods(), [input, kind](const DecimationMethod& method) {
            const Mesh result = method.compute(*input);
            return MethodError(surface_errors(result, input->surface, surface_seed, kind),
                               fmt::format("{} triangles", result.triangles.size()));
        });
    prepared.costs.memory = false;
    return prepared;
}

PreparedExperiment decimation_case(AnalyticSurface surface, DecimationError kind,
                                   const PlanOptions& options) {
    const int cells = options.is_quick ? 64 : 256;
    PreparedExperiment prepared = decimation_of(surface, cells, kind);
    prepared.finish = [surface, cells, kind, is_quick = options.is_quick](Experiment& report) {
        report.charts = {triangles_chart(DecimationInput(surface, cells), kind, is_quick)};
    };
    return prepared;
}

PreparedExperiment decimation_of_large_mesh(const PlanOptions& options) {
    PreparedExperiment prepared = decimation_of(
        AnalyticSurface::torus, options.is_quick ? 128 : 707, DecimationError::distance);
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
    const std::vector<AnalyticSurface> surfaces =
        options.is_quick ? std::vector{torus, ellipsoid}
                         : std::vector<AnalyticSurface>(all_surfaces.begin(), all_surfaces.end());
    std::vector<PlannedExperiment> plan;
    for (const AnalyticSurface surface : surfaces) {
        for (const DecimationError kind : {DecimationError::distance, DecimationError::angle}) {
            const char* name = kind == DecimationError::angle ? "angle" : "distance";
            plan.push_back(
                {fmt::format("decimation/{}-{}", name_of(surface), name),
                 fmt::format("Decimation: {}, {}", name_of(surface), name),
                 [=](const PlanOptions& all) { return decimation_case(surface, kind, all); }});
        }
    }
    plan.push_back({"decimation/large", "Decimation: a large mesh", decimation_of_large_mesh});
    return plan;
}

}  // namespace relief::accuracy::detail
