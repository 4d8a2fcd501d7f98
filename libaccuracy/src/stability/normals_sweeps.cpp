// SPDX-License-Identifier: Apache-2.0
// Normals of a torus that shrinks, grows and moves away, and of ever narrower triangles. Tests:
// tests/accuracy/stability_experiments_test.cpp.
#include <fmt/format.h>

#include <array>

#include "normals/normal_methods.h"
#include "relief/mesh/direction_error.h"
#include "stability/needles.h"
#include "stability/plain_code.h"
#include "stability/stability_plan.h"
#include "stability/sweep.h"

namespace relief {
namespace {

constexpr std::uint32_t sweep_seed = 1;
constexpr std::array arithmetics = {Arithmetic::float64, Arithmetic::float32};

NormalMethod plain(const char* name, std::vector<glm::vec3> (*normals)(const Mesh&)) {
    NormalMethod method;
    method.weighting = name;
    method.arithmetic = Arithmetic::float32;
    method.normals = normals;
    return method;
}

/// relief's, and plain code's.
std::vector<NormalMethod> swept_normal_methods() {
    std::vector<NormalMethod> methods = normal_methods(arithmetics);
    methods.push_back(plain("plain area", plain_area_normals));
    methods.push_back(plain("plain angle", plain_angle_normals));
    return methods;
}

std::vector<std::string> normal_names(const std::vector<NormalMethod>& methods) {
    std::vector<std::string> names;
    for (const NormalMethod& method : methods)
        names.push_back(method.name());
    return names;
}

std::vector<float> degrees_from(const std::vector<glm::vec3>& normals,
                                const std::vector<glm::dvec3>& truth) {
    std::vector<float> degrees;
    for (std::size_t v = 0; v < normals.size(); ++v)
        degrees.push_back(static_cast<float>(degrees_between(glm::dvec3(normals[v]), truth[v])));
    return degrees;
}

AnalyticMesh analytic_torus(const RunOptions& options) {
    return analytic_mesh(AnalyticSurface::torus, Triangulation::regular, options.is_quick ? 32 : 64,
                         sweep_seed);
}

/// Vertices are moved and scaled in double, and then rounded to float as any file would.
Mesh changed(Mesh mesh, double scale, double offset) {
    for (glm::vec3& position : mesh.positions)
        position = glm::vec3(glm::dvec3(position) * scale + offset);
    return mesh;
}

/// A measurement of each method: errors of the sweeps, time on `mesh`.
void measure_normals(const std::vector<NormalMethod>& methods, const Sweeps& sweeps,
                     const Mesh& mesh, const RunOptions& options, Experiment& experiment) {
    std::vector<MeasuredMethod> measured;
    for (const NormalMethod& method : methods) {
        measured.push_back({.name = method.name(),
                            .choices = method.choices(),
                            .error = {},
                            .work = [&mesh, normals = method.normals] { normals(mesh); }});
    }
    experiment.item = "triangle";
    experiment.items = static_cast<double>(mesh.triangles.size());
    measure_swept(std::move(measured), sweeps, options, experiment);
}

constexpr const char* torus_truth =
    "the torus's own normals in closed form, which neither scale nor place change; tests "
    "differentiate the surface numerically as well";

}  // namespace

Experiment normals_by_scale(const RunOptions& options) {
    const AnalyticMesh truth = analytic_torus(options);
    const std::vector<NormalMethod> methods = swept_normal_methods();
    Sweeps sweeps(normal_names(methods), broken_degrees);
    const auto scaled = [&](bool is_larger) {
        return [&, is_larger](std::size_t method, double value) {
            const Mesh mesh = changed(truth.mesh, is_larger ? value : 1.0 / value, 0.0);
            return degrees_from(methods[method].normals(mesh), truth.normals);
        };
    };
    sweeps.add("smaller", "Smaller", "times smaller than radius 1", 30, 2, scaled(false));
    sweeps.add("larger", "Larger", "times larger than radius 1", 30, 2, scaled(true));
    Experiment experiment{
        .id = "stability/normals-scale",
        .question = "In which units may a mesh be, before its normals are wrong?",
        .truth = torus_truth,
        .input = fmt::format("torus of {} triangles at 31 scales from 1e-30 to 1e30; errors of all "
                             "together, times at scale 1",
                             truth.mesh.triangles.size())};
    measure_normals(methods, sweeps, truth.mesh, options, experiment);
    return experiment;
}

Experiment normals_by_offset(const RunOptions& options) {
    const AnalyticMesh truth = analytic_torus(options);
    const std::vector<NormalMethod> methods = swept_normal_methods();
    Sweeps sweeps(normal_names(methods), broken_degrees);
    sweeps.add("offset", "Farther away", "distance along each axis, in radii of the torus", 8, 1,
               [&](std::size_t method, double value) {
                   const Mesh mesh = changed(truth.mesh, 1.0, value);
                   return degrees_from(methods[method].normals(mesh), truth.normals);
               });
    Experiment experiment{
        .id = "stability/normals-offset",
        .question = "How far from the origin may a mesh be, before its normals are wrong?",
        .truth = torus_truth,
        .input = fmt::format("torus of {} triangles at 9 distances from 1 to 1e8; errors of all "
                             "together, times without one",
                             truth.mesh.triangles.size())};
    measure_normals(methods, sweeps, truth.mesh, options, experiment);
    experiment.finding +=
        " float64 is exact for the positions that it is given: what it errs is what rounding these "
        "to float has done, which no method can undo. Move meshes to the origin before they are "
        "stored.";
    return experiment;
}

Experiment normals_of_needles(const RunOptions& options) {
    const std::size_t count = options.is_quick ? 1000 : 4000;
    const std::vector<NormalMethod> methods = swept_normal_methods();
    Sweeps sweeps(normal_names(methods), broken_degrees);
    sweeps.add("width", "Narrower", "length over width", 12, 1,
               [&](std::size_t method, double value) {
                   const Needles needles = make_needles(count, 1.0 / value, sweep_seed);
                   return degrees_from(methods[method].normals(needles.mesh), needles.normals);
               });
    const Needles wide = make_needles(count, 1.0, sweep_seed);
    Experiment experiment{
        .id = "stability/normals-needles",
        .question = "How narrow may a triangle be, before its normal is wrong?",
        .truth =
            "the cross product of the float corners in double, of two of which lie so near "
            "the origin that nothing cancels; a test has the same from integers",
        .input = fmt::format("{} single triangles at 13 widths from 1 to 1e-12 of their length; "
                             "errors of all together, times at width 1",
                             count)};
    measure_normals(methods, sweeps, wide.mesh, options, experiment);
    return experiment;
}

}  // namespace relief
