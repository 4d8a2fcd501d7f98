// SPDX-License-Identifier: Apache-2.0
// Vertex normals beside the plainest loop that gives any: what stability and determinism cost.
#include "relief/mesh/normals.h"

#include <benchmark/benchmark.h>

#include "mesh/bumpy_sphere.h"
#include "relief/mesh/threads.h"

namespace relief::bench {
namespace {

/// The naive best: area-weighted float scatter. Overflows, underflows, splits at seams, and returns
/// NaN where triangles vanish.
std::vector<glm::vec3> naive_area_normals(const Mesh& mesh) {
    std::vector<glm::vec3> normals(mesh.positions.size(), glm::vec3(0.0F));
    for (const glm::uvec3& triangle : mesh.triangles) {
        const glm::vec3& origin = mesh.positions[triangle[0]];
        const glm::vec3 area_normal =
            glm::cross(mesh.positions[triangle[1]] - origin, mesh.positions[triangle[2]] - origin);
        for (int corner = 0; corner < 3; ++corner)
            normals[triangle[corner]] += area_normal;
    }
    for (glm::vec3& normal : normals)
        normal = glm::normalize(normal);
    return normals;
}

void per_triangle(benchmark::State& state, const Mesh& mesh) {
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.triangles.size()));
}

void normals_naive_area(benchmark::State& state) {
    const Mesh mesh = bumpy_sphere(static_cast<std::size_t>(state.range(0)));
    for (auto _ : state)
        benchmark::DoNotOptimize(naive_area_normals(mesh));
    per_triangle(state, mesh);
}

void normals_relief(benchmark::State& state, NormalWeight weight) {
    const Mesh mesh = bumpy_sphere(static_cast<std::size_t>(state.range(0)));
    set_thread_limit(static_cast<unsigned>(state.range(1)));
    for (auto _ : state) {
        Report report;
        benchmark::DoNotOptimize(vertex_normals(mesh.positions, mesh.triangles, weight, report));
    }
    set_thread_limit(0);
    per_triangle(state, mesh);
}

BENCHMARK(normals_naive_area)->Arg(1'000'000)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(normals_relief, area, NormalWeight::area)
    ->ArgNames({"triangles", "threads"})
    ->ArgsProduct({{1'000'000}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(normals_relief, angle, NormalWeight::angle)
    ->ArgNames({"triangles", "threads"})
    ->ArgsProduct({{1'000'000}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relief::bench
