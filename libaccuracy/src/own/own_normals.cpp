// SPDX-License-Identifier: Apache-2.0
// Weightings by the corners whose true normal is known; hard edges are those of own_creases.h.
// Tests: tests/accuracy/own_mesh_test.cpp.
#include "own/own_normals.h"

#include <fmt/format.h>

#include <algorithm>

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
    double own_degrees = 0.0;
    std::string words;
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
        "smooth surface. There it is itself known to {:.2g} degrees. It takes the vertices for "
        "points of the surface, and cannot judge models whose vertices are not.",
        creases.words, fitted.corners.size(), fitted.places, fitted.own_degrees);
    constexpr std::size_t fewest = 16;
    truth.is_enough = fitted.corners.size() >= std::max(fewest, fitted.places / 10);
    truth.own_degrees = fitted.own_degrees;
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
    for (const NormalMethod& method : normal_methods(both_arithmetics)) {
        const auto normals = [method, &mesh, &creases] {
            return creases.has_any() ? with_creases(method, mesh, creases) : method.normals(mesh);
        };
        OwnMethod own;
        own.measured = {.name = method.name(),
                        .choices = method.choices(),
                        .error = errors_of(normals(), creases.has_any(), mesh, truth),
                        .work = [normals] { normals(); }};
        // What the tool computes in.
        if (method.arithmetic == Arithmetic::float64) {
            own.command = fmt::format("relief-mesh process {} -o OUT.glb --normals {}{}",
                                      options.arguments, method.weighting, creases.option);
        }
        methods.push_back(std::move(own));
    }
    return methods;
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
                            .choices = {{"weighting", "file"}, {"arithmetic", "file"}},
                            .error = errors_of(mesh.normals, false, mesh, truth),
                            .note = "as they are stored; no time"},
                           {}});
    }
    if (!truth.is_enough) {
        for (OwnMethod& method : methods)
            method.command.clear();
    }
    finish(own, std::move(methods), CostKind::time, truth.own_degrees, options);
    if (!truth.is_enough) {
        own.recommendation.words =
            "no recommendation: the mesh is too coarse, or too rough, for a smooth surface to be "
            "fitted through it; its own normals can be the measure (--truth file)";
        tell_finding(own);
    }
    return own;
}

}  // namespace relief
