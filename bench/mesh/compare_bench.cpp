// SPDX-License-Identifier: Apache-2.0
// Comparison of two meshes by corners, with equal and slightly different positions and on a fan
// around one vertex; and identification of the tangent method.
#include "relief/mesh/compare.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "mesh/bumpy_sphere.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/tangents.h"

namespace relief::bench {
namespace {

constexpr std::uint32_t triangles_compared = 1'000'000;

Mesh sphere() {
    Report report;
    return with_frames(bumpy_sphere(triangles_compared), {.tangents = TangentMethod::mikktspace},
                       report)
        .mesh;
}

Mesh fan() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}};
    for (std::uint32_t i = 0; i < triangles_compared; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / triangles_compared;
        mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0.0F);
        mesh.triangles.emplace_back(0, i + 1, (i + 1) % triangles_compared + 1);
    }
    mesh.normals.assign(mesh.positions.size(), glm::vec3(0, 0, 1));
    return mesh;
}

/// The mesh with shuffled triangles, and vertices displaced by at most `distance` along each axis.
Mesh shuffled(Mesh mesh, float distance) {
    std::mt19937 random(1);
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
    std::uniform_real_distribution<float> by(-distance, distance);
    for (glm::vec3& position : mesh.positions) {
        if (distance > 0.0F) position += glm::vec3(by(random), by(random), by(random));
    }
    return mesh;
}

void compare(benchmark::State& state, Mesh (*make)(), float distance) {
    const Mesh a = make();
    const Mesh b = shuffled(a, distance);
    set_thread_limit(static_cast<unsigned>(state.range(0)));
    MatchOptions options;
    options.position_tolerance = 2.0 * static_cast<double>(distance);
    for (auto _ : state) {
        const CornerMatch match = match_corners(a, b, options);
        benchmark::DoNotOptimize(
            compared(corner_differences(a, b, match), match, 0, a.triangles.size()));
    }
    set_thread_limit(0);
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(a.triangles.size()));
}

void identify(benchmark::State& state) {
    const Mesh mesh = sphere();
    set_thread_limit(static_cast<unsigned>(state.range(0)));
    for (auto _ : state)
        benchmark::DoNotOptimize(identify_tangents(mesh));
    set_thread_limit(0);
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.triangles.size()));
}

#define RELIEF_ON_THREADS \
    ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond)

BENCHMARK_CAPTURE(compare, sphere_equal, sphere, 0.0F)->RELIEF_ON_THREADS;
BENCHMARK_CAPTURE(compare, sphere_near, sphere, 1e-6F)->RELIEF_ON_THREADS;
BENCHMARK_CAPTURE(compare, fan_equal, fan, 0.0F)->RELIEF_ON_THREADS;
BENCHMARK_CAPTURE(compare, fan_near, fan, 1e-8F)->RELIEF_ON_THREADS;
BENCHMARK(identify)->RELIEF_ON_THREADS;

}  // namespace
}  // namespace relief::bench
