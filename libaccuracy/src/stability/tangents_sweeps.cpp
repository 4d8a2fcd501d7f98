// SPDX-License-Identifier: Apache-2.0
// Tangents of a torus and an image on it that shrink, grow and move away. Tests:
// tests/accuracy/stability_experiments_test.cpp.
#include <fmt/format.h>

#include "relief/mesh/direction_error.h"
#include "stability/plain_code.h"
#include "stability/stability_plan.h"
#include "stability/sweep.h"
#include "tangents/tangent_methods.h"

namespace relief {
namespace {

/// Those that are stored, and plain code's.
std::vector<TangentMethod> swept_tangent_methods() {
    std::vector<TangentMethod> methods = tangent_methods();
    std::erase_if(methods, [](const TangentMethod& method) { return !method.tangents; });
    methods.push_back({"plain", plain_tangents});
    return methods;
}

TexturedMesh textured_torus(const RunOptions& options) {
    return textured_mesh(AnalyticSurface::torus, Triangulation::regular, TextureLayout::upright,
                         options.is_quick ? 32 : 64, 1);
}

/// What is done to positions or texture coordinates.
struct Change {
    double scale = 1.0;
    double offset = 0.0;

    template <typename Vector>
    void apply(std::vector<Vector>& values) const {
        for (Vector& value : values) {
            for (glm::length_t i = 0; i < Vector::length(); ++i)
                value[i] = static_cast<float>(static_cast<double>(value[i]) * scale + offset);
        }
    }
};

/// Errors of a method on the torus, changed; in double, and then rounded to float.
std::vector<float> degrees_of(const TangentMethod& method, const TexturedMesh& truth,
                              const Change& positions, const Change& texcoords) {
    Mesh mesh = truth.mesh;
    positions.apply(mesh.positions);
    texcoords.apply(mesh.texcoords);
    const CornerTangents found = method.tangents_of(mesh);
    const CornerTangents expected = true_tangents(truth);
    std::vector<float> degrees;
    for (std::size_t corner = 0; corner < found.size(); ++corner) {
        const std::uint32_t vertex =
            truth.mesh.triangles[corner / 3][static_cast<glm::length_t>(corner % 3)];
        if (truth.inner[vertex] == 0) continue;
        degrees.push_back(static_cast<float>(
            degrees_between(glm::dvec3(found[corner]), glm::dvec3(expected[corner]))));
    }
    return degrees;
}

void measure_tangents(const std::vector<TangentMethod>& methods, const Sweeps& sweeps,
                      const TexturedMesh& truth, const RunOptions& options,
                      Experiment& experiment) {
    experiment.truth =
        "the directions along which the image lies on the torus, in closed form, which neither "
        "scale nor place change; tests differentiate the surface numerically as well";
    std::vector<MeasuredMethod> measured;
    for (const TangentMethod& method : methods) {
        measured.push_back(
            {.name = method.name,
             .choices = {{"frames", method.name}},
             .error = {},
             .work = [&truth, tangents = method.tangents] { tangents(truth.mesh); }});
    }
    experiment.item = "triangle";
    experiment.items = static_cast<double>(truth.mesh.triangles.size());
    measure_swept(std::move(measured), sweeps, options, experiment);
}

}  // namespace

Experiment tangents_by_scale(const RunOptions& options) {
    const TexturedMesh truth = textured_torus(options);
    const std::vector<TangentMethod> methods = swept_tangent_methods();
    Sweeps sweeps(names_of(methods), broken_degrees);
    const auto add = [&](const char* id, const char* title, const char* label, bool is_image,
                         bool is_larger) {
        sweeps.add(id, title, label, 30, 2, [&, is_image, is_larger](std::size_t i, double value) {
            const Change change{.scale = is_larger ? value : 1.0 / value};
            return is_image ? degrees_of(methods[i], truth, {}, change)
                            : degrees_of(methods[i], truth, change, {});
        });
    };
    add("smaller", "Smaller meshes", "times smaller than radius 1", false, false);
    add("larger", "Larger meshes", "times larger than radius 1", false, true);
    add("smaller-image", "Smaller texture coordinates", "times smaller than one image", true,
        false);
    add("larger-image", "Larger texture coordinates", "times larger than one image", true, true);
    Experiment experiment{
        .id = "stability/tangents-scale",
        .question =
            "In which units may a mesh and its texture coordinates be, before tangents are "
            "wrong?",
        .input = fmt::format("torus of {} triangles, its positions and its texture coordinates at "
                             "31 scales each from 1e-30 to 1e30; errors of all together, times at "
                             "scale 1",
                             truth.mesh.triangles.size())};
    measure_tangents(methods, sweeps, truth, options, experiment);
    return experiment;
}

Experiment tangents_by_offset(const RunOptions& options) {
    const TexturedMesh truth = textured_torus(options);
    const std::vector<TangentMethod> methods = swept_tangent_methods();
    Sweeps sweeps(names_of(methods), broken_degrees);
    sweeps.add("offset", "Meshes farther away", "distance along each axis, in radii", 8, 1,
               [&](std::size_t i, double value) {
                   return degrees_of(methods[i], truth, {.offset = value}, {});
               });
    sweeps.add("offset-image", "Texture coordinates farther away",
               "distance along each axis, in images", 8, 1, [&](std::size_t i, double value) {
                   return degrees_of(methods[i], truth, {}, {.offset = value});
               });
    Experiment experiment{
        .id = "stability/tangents-offset",
        .question =
            "How far from the origin may a mesh and its texture coordinates be, before "
            "tangents are wrong?",
        .input = fmt::format("torus of {} triangles, its positions and its texture coordinates at "
                             "9 distances each from 1 to 1e8; errors of all together, times "
                             "without one",
                             truth.mesh.triangles.size())};
    measure_tangents(methods, sweeps, truth, options, experiment);
    return experiment;
}

}  // namespace relief
