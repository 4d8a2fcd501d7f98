// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/stability_experiments_test.cpp.
#include "stability/swept_normals.h"

#include "analytic_words.h"
#include "relief/mesh/direction_error.h"
#include "stability/plain_code.h"

namespace relief {
namespace {

constexpr std::uint32_t torus_seed = 1;

NormalMethod plain_method(const char* name, std::vector<glm::vec3> (*normals)(const Mesh&)) {
    NormalMethod method;
    method.weighting = name;
    method.arithmetic = Arithmetic::float32;
    method.normals = normals;
    return method;
}

}  // namespace

AnalyticMesh swept_torus(const RunOptions& options) {
    return analytic_mesh(AnalyticSurface::torus, Triangulation::regular, options.is_quick ? 32 : 64,
                         torus_seed);
}

std::vector<NormalMethod> swept_normal_methods() {
    std::vector<NormalMethod> methods = normal_methods(both_arithmetics);
    methods.push_back(plain_method("plain area", plain_area_normals));
    methods.push_back(plain_method("plain angle", plain_angle_normals));
    return methods;
}

std::vector<std::string> swept_names(const std::vector<NormalMethod>& methods) {
    std::vector<std::string> names;
    for (const NormalMethod& method : methods)
        names.push_back(method.name());
    return names;
}

std::vector<float> degrees_off(const std::vector<glm::vec3>& normals,
                               const std::vector<glm::dvec3>& truth) {
    std::vector<float> degrees;
    for (std::size_t v = 0; v < truth.size(); ++v)
        degrees.push_back(static_cast<float>(degrees_between(glm::dvec3(normals[v]), truth[v])));
    return degrees;
}

void measure_swept_normals(const std::vector<NormalMethod>& methods, const Sweeps& sweeps,
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

}  // namespace relief
