// SPDX-License-Identifier: Apache-2.0
// Hard triangles, and the sweep of how many a mesh has. Tests:
// tests/accuracy/hard_triangles_test.cpp, stability_experiments_test.cpp.
#include "stability/hard_triangles.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "stability/stability_plan.h"
#include "stability/swept_normals.h"

namespace relief {
namespace {

std::uint32_t added_vertex(Mesh& mesh, const glm::vec3& position) {
    mesh.positions.push_back(position);
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

/// The hard triangle beside a sound one.
glm::uvec3 hard_one(Mesh& mesh, const glm::uvec3& beside, HardTriangle kind) {
    const auto& [a, b, c] = std::array{beside.x, beside.y, beside.z};
    constexpr float no_number = std::numeric_limits<float>::quiet_NaN();
    switch (kind) {
        case HardTriangle::collapsed:
            return {a, b, b};
        case HardTriangle::coinciding:
            return {a, b, added_vertex(mesh, mesh.positions[b])};
        case HardTriangle::needle:
            return {a, b, added_vertex(mesh, 0.5F * (mesh.positions[a] + mesh.positions[b]))};
        case HardTriangle::nowhere:
            return {a, b, added_vertex(mesh, glm::vec3(no_number))};
        case HardTriangle::back:
            break;
    }
    return {a, c, b};
}

}  // namespace

Mesh with_hard_triangles(const Mesh& mesh, HardTriangle kind, std::size_t count) {
    Mesh hard;
    hard.positions = mesh.positions;
    hard.triangles = mesh.triangles;
    const std::size_t own = mesh.triangles.size();
    if (kind == HardTriangle::back) count = std::min(count, own);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::uvec3 beside = mesh.triangles[i * own / count];
        hard.triangles.push_back(hard_one(hard, beside, kind));
    }
    return hard;
}

Experiment normals_beside_hard_triangles(const RunOptions& options) {
    const AnalyticMesh truth = swept_torus(options);
    const std::vector<NormalMethod> methods = swept_normal_methods();
    Sweeps sweeps(swept_names(methods), broken_degrees);
    for (const HardTriangleWords& one : hard_triangle_words) {
        sweeps.add(
            one.id, one.title, "how many of them", 3, 1, [&](std::size_t method, double count) {
                const Mesh mesh =
                    with_hard_triangles(truth.mesh, one.kind, static_cast<std::size_t>(count));
                return degrees_off(methods[method].normals(mesh), truth.normals);
            });
    }
    Experiment experiment{
        .id = "stability/normals-hard-triangles",
        .question =
            "How many triangles of the hard-case catalogue may a mesh have, before the "
            "normals around them are wrong?",
        .truth = fmt::format("{}; what is added has no area, no place or two sides, and so is no "
                             "part of the surface",
                             torus_truth_words),
        .input = fmt::format("torus of {} triangles with 1 to 1000 hard ones more, of five kinds; "
                             "errors of all together, times without them",
                             truth.mesh.triangles.size())};
    measure_swept_normals(methods, sweeps, truth.mesh, options, experiment);
    return experiment;
}

}  // namespace relief
