// SPDX-License-Identifier: Apache-2.0
// Weightings by the corners whose true normal is known; hard edges are those of own_creases.h.
// Tests: tests/accuracy/own_mesh_test.cpp.
#include "own/own_normals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "analytic_words.h"
#include "normals/normal_methods.h"
#include "own/own_creases.h"
#include "own/own_experiment.h"
#include "relief/mesh/angle_distribution.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/error.h"
#include "relief/mesh/fitted_normals.h"

namespace relief {
namespace {

/// Where the truth is known, and what it is.
struct CornerTruth {
    std::vector<std::uint32_t> corners;
    std::vector<glm::dvec3> normals;
    std::optional<double> own_degrees{};  ///< What it is itself off, where it is an estimate.
    std::string words;
    double unjudged = 0.0;  ///< Share of the places looked at without a known normal.
    bool is_enough = true;  ///< To recommend something.
};

CornerTruth by_surface(const Mesh& mesh, const OwnCreases& creases) {
    FitOptions fit;
    fit.hard_edges = creases.edges;
    FittedNormals fitted = fitted_normals(mesh, fit);
    CornerTruth truth;
    truth.words = fmt::format(
        "A smooth surface fitted through the vertices (degree 4, three rings of triangles; {}). "
        "Known at {} of {} places looked at; at the others there are too few neighbours, or no "
        "smooth surface. Where it is known, it has an expected error of {:.2g} degrees itself. It "
        "takes the vertices for points of the surface, and cannot judge models whose vertices are "
        "not.",
        creases.words, fitted.corners.size(), fitted.places, fitted.own_degrees);
    constexpr std::size_t fewest = 16;
    truth.is_enough = fitted.corners.size() >= std::max(fewest, fitted.places / 10);
    truth.own_degrees = fitted.own_degrees;
    if (fitted.places > 0) {
        truth.unjudged =
            1.0 - static_cast<double>(fitted.corners.size()) / static_cast<double>(fitted.places);
    }
    truth.corners = std::move(fitted.corners);
    truth.normals = std::move(fitted.normals);
    return truth;
}

/// Of each vertex that has a triangle, at the first corner there.
CornerTruth by_file(const Mesh& mesh, const OwnCreases& creases) {
    if (mesh.normals.empty()) throw InvalidInput("the mesh has no normals to compare with");
    CornerTruth truth;
    truth.words = fmt::format(
        "The normals that the file holds ({}). They tell which method comes nearest to whatever "
        "made them, not which is nearest to a surface.",
        creases.words);
    std::vector<unsigned char> is_seen(mesh.positions.size(), 0);
    for (std::uint32_t corner = 0; corner < 3 * mesh.triangles.size(); ++corner) {
        const std::uint32_t vertex = mesh.triangles[corner / 3][static_cast<int>(corner % 3)];
        if (is_seen[vertex]++ > 0) continue;
        truth.corners.push_back(corner);
        truth.normals.emplace_back(mesh.normals[vertex]);
        is_seen[vertex] = 1;
    }
    return truth;
}

/// \param normals  by corner, or by vertex
ErrorFigures errors_of(const std::vector<glm::vec3>& normals, bool are_by_corner, const Mesh& mesh,
                       const CornerTruth& truth) {
    std::vector<float> degrees;
    for (std::size_t i = 0; i < truth.corners.size(); ++i) {
        const std::uint32_t corner = truth.corners[i];
        const glm::vec3& found =
            are_by_corner ? normals[corner]
                          : normals[mesh.triangles[corner / 3][static_cast<int>(corner % 3)]];
        degrees.push_back(static_cast<float>(degrees_between(glm::dvec3(found), truth.normals[i])));
    }
    return figures_of(angle_distribution(std::move(degrees)));
}

std::vector<glm::vec3> with_creases(const NormalMethod& method, const Mesh& mesh,
                                    const OwnCreases& creases) {
    Report report;
    NormalOptions how;
    how.arithmetic = method.arithmetic;
    return corner_normals(mesh.positions, mesh.triangles, method.weight, how, creases.edges, report)
        .normals;
}

std::vector<OwnMethod> methods_on(const Mesh& mesh, const OwnCreases& creases,
                                  const CornerTruth& truth, const OwnOptions& options) {
    std::vector<OwnMethod> methods;
    // In double alone: relief-mesh computes in it, and has no option for another arithmetic.
    for (const NormalMethod& method : normal_methods(std::array{Arithmetic::float64})) {
        const auto normals = [method, &mesh, &creases] {
            return creases.has_any() ? with_creases(method, mesh, creases) : method.normals(mesh);
        };
        OwnMethod own;
        own.measured = {.name = std::string(method.weighting),
                        .choices = {{"weighting", std::string(method.weighting)}},
                        .error = errors_of(normals(), creases.has_any(), mesh, truth),
                        .work = [normals] { normals(); }};
        own.command = fmt::format("relief-mesh process {} -o OUT.glb --normals {}{}",
                                  options.arguments, method.weighting, creases.option);
        methods.push_back(std::move(own));
    }
    return methods;
}

/// Says which methods the reference cannot tell from the recommended one, and how many vertices no
/// method was judged at.
void add_caveats(OwnExperiment& own, const CornerTruth& truth, const OwnCreases& creases) {
    if (!own.recommendation.method) return;
    std::string& words = own.recommendation.words;
    const std::size_t taken = *own.recommendation.method;
    const std::vector<Measurement>& all = own.experiment.measurements;
    std::vector<std::string> alike;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const double difference = std::abs(all[i].error.rms - all[taken].error.rms);
        if (i != taken && !own.commands[i].empty() && difference < truth.own_degrees.value_or(0.0))
            alike.push_back(all[i].method);
    }
    if (!alike.empty()) {
        words += fmt::format(
            "; not told apart from {}, whose errors differ from it by less than the {:.2g} degrees "
            "of the fitted surface itself",
            fmt::join(alike, ", "), *truth.own_degrees);
    }
    constexpr double worth_saying = 0.05;
    if (truth.unjudged < worth_saying) return;
    words += fmt::format(
        "; {:.0f} % of the vertices are not judged, as no smooth surface goes "
        "through them",
        100.0 * truth.unjudged);
    if (!creases.has_any()) words += " (if the mesh has hard edges, try --crease 40)";
}

}  // namespace

OwnExperiment own_normals(const Mesh& mesh, const std::string& whole,
                          const OwnMeshOptions& mesh_options, const OwnOptions& options) {
    OwnExperiment own = own_experiment(Subject::normals, "normals", "Normals", options);
    const OwnCreases creases = own_creases(mesh, mesh_options.crease_angle);
    const bool is_file = mesh_options.truth == NormalTruth::file;
    const CornerTruth truth = is_file ? by_file(mesh, creases) : by_surface(mesh, creases);
    Experiment& experiment = own.experiment;
    experiment.question = is_file ? "Which weighting comes nearest to the normals of this file?"
                                  : "Which weighting is closest to the normals of the surface that "
                                    "this mesh stands for, and what does it cost?";
    experiment.truth = truth.words;
    experiment.input = fmt::format("{} triangles{}", mesh.triangles.size(), whole);
    experiment.item = "triangle";
    experiment.items = static_cast<double>(mesh.triangles.size());
    std::vector<OwnMethod> methods = methods_on(mesh, creases, truth, options);
    if (!is_file && !mesh.normals.empty()) {
        methods.push_back({{.name = "the file's own",
                            .choices = {{"weighting", "file"}},
                            .error = errors_of(mesh.normals, false, mesh, truth),
                            .note = "as they are stored; no time"},
                           {}});
    }
    if (!truth.is_enough) {
        for (OwnMethod& method : methods)
            method.command.clear();
    }
    experiment.reference_error = truth.own_degrees;
    finish(own, std::move(methods), {.reference = "the fitted surface itself"}, options);
    if (truth.is_enough) {
        add_caveats(own, truth, creases);
    } else {
        own.recommendation.words =
            "no recommendation: the mesh is too coarse, or too rough, for a smooth surface to be "
            "fitted through it; its own normals can be the measure (--truth file)";
    }
    tell_finding(own);
    return own;
}

}  // namespace relief
