// SPDX-License-Identifier: Apache-2.0
// Normals of a torus that shrinks, grows and moves away, and of ever narrower triangles. Tests:
// tests/accuracy/stability_experiments_test.cpp.
#include <fmt/format.h>

#include "stability/needles.h"
#include "stability/stability_plan.h"
#include "stability/swept_normals.h"

namespace relief {
namespace {

constexpr std::uint32_t needles_seed = 1;

/// Vertices are moved and scaled in double, and then rounded to float as any file would.
Mesh changed(Mesh mesh, double scale, double offset) {
    for (glm::vec3& position : mesh.positions)
        position = glm::vec3(glm::dvec3(position) * scale + offset);
    return mesh;
}

}  // namespace

Experiment normals_by_scale(const RunOptions& options) {
    const AnalyticMesh truth = swept_torus(options);
    const std::vector<NormalMethod> methods = swept_normal_methods();
    Sweeps sweeps(swept_names(methods), broken_degrees);
    const auto scaled = [&](bool is_larger) {
        return [&, is_larger](std::size_t method, double value) {
            const Mesh mesh = changed(truth.mesh, is_larger ? value : 1.0 / value, 0.0);
            return degrees_off(methods[method].normals(mesh), truth.normals);
        };
    };
    sweeps.add("smaller", "Smaller", "times smaller than radius 1", 30, 2, scaled(false));
    sweeps.add("larger", "Larger", "times larger than radius 1", 30, 2, scaled(true));
    Experiment experiment{
        .id = "stability/normals-scale",
        .question = "In which units may a mesh be, before its normals are wrong?",
        .truth = torus_truth_words,
        .input = fmt::format("torus of {} triangles at 31 scales from 1e-30 to 1e30; errors of all "
                             "together, times at scale 1",
                             truth.mesh.triangles.size())};
    measure_swept_normals(methods, sweeps, truth.mesh, options, experiment);
    return experiment;
}

Experiment normals_by_offset(const RunOptions& options) {
    const AnalyticMesh truth = swept_torus(options);
    const std::vector<NormalMethod> methods = swept_normal_methods();
    Sweeps sweeps(swept_names(methods), broken_degrees);
    sweeps.add("offset", "Farther away", "distance along each axis, in radii of the torus", 8, 1,
               [&](std::size_t method, double value) {
                   const Mesh mesh = changed(truth.mesh, 1.0, value);
                   return degrees_off(methods[method].normals(mesh), truth.normals);
               });
    Experiment experiment{
        .id = "stability/normals-offset",
        .question = "How far from the origin may a mesh be, before its normals are wrong?",
        .truth = torus_truth_words,
        .input = fmt::format("torus of {} triangles at 9 distances from 1 to 1e8; errors of all "
                             "together, times without one",
                             truth.mesh.triangles.size())};
    measure_swept_normals(methods, sweeps, truth.mesh, options, experiment);
    experiment.finding +=
        " float64 is exact for the positions that it is given: what it errs is what rounding these "
        "to float has done, which no method can undo. Move meshes to the origin before they are "
        "stored.";
    return experiment;
}

Experiment normals_of_needles(const RunOptions& options) {
    const std::size_t count = options.is_quick ? 1000 : 4000;
    const std::vector<NormalMethod> methods = swept_normal_methods();
    Sweeps sweeps(swept_names(methods), broken_degrees);
    sweeps.add("width", "Narrower", "length over width", 12, 1,
               [&](std::size_t method, double value) {
                   const Needles needles = make_needles(count, 1.0 / value, needles_seed);
                   return degrees_off(methods[method].normals(needles.mesh), needles.normals);
               });
    const Needles wide = make_needles(count, 1.0, needles_seed);
    Experiment experiment{
        .id = "stability/normals-needles",
        .question = "How narrow may a triangle be, before its normal is wrong?",
        .truth =
            "the cross product of the float corners in double, of two of which lie so near "
            "the origin that nothing cancels; a test has the same from integers",
        .input = fmt::format("{} single triangles at 13 widths from 1 to 1e-12 of their length; "
                             "errors of all together, times at width 1",
                             count)};
    measure_swept_normals(methods, sweeps, wide.mesh, options, experiment);
    return experiment;
}

}  // namespace relief
