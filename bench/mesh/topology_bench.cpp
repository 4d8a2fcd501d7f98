// SPDX-License-Identifier: Apache-2.0
// Decimation, comparison and diagnosis of meshes, also on shapes on which simple algorithms need
// quadratic time or hours; and the memory bandwidth. The counter `bytes` of decimation is the
// growth of the peak memory of the process per triangle, so it is meaningful only for the first
// benchmark of a run: select one with
// --benchmark_filter.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>
#include <random>
#include <vector>

#include "bench_support.h"
#include "relief/mesh/compare.h"
#include "relief/mesh/diagnose.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/tangents.h"
#include "relief/mesh/topology.h"

namespace relief::bench {
namespace {

double peak_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// A torus of radii 1 and 0.35 with 2 * cells^2 triangles.
Mesh torus(std::uint32_t cells) {
    Mesh mesh;
    const double step = 2.0 * std::numbers::pi / cells;
    for (std::uint32_t i = 0; i < cells; ++i) {
        for (std::uint32_t j = 0; j < cells; ++j) {
            const double across = 1.0 + 0.35 * std::cos(j * step);
            mesh.positions.emplace_back(across * std::cos(i * step), across * std::sin(i * step),
                                        0.35 * std::sin(j * step));
        }
    }
    for (std::uint32_t i = 0; i < cells; ++i) {
        for (std::uint32_t j = 0; j < cells; ++j) {
            const auto at = [&](std::uint32_t x, std::uint32_t y) {
                return x % cells * cells + y % cells;
            };
            mesh.triangles.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
            mesh.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    return mesh;
}

/// A sphere with two poles of valence 2 * rings, of about 4 * rings^2 triangles.
Mesh sphere(std::uint32_t rings) {
    Mesh mesh;
    const std::uint32_t around = 2 * rings;
    for (std::uint32_t i = 1; i < rings; ++i) {
        const double polar = i * std::numbers::pi / rings;
        for (std::uint32_t j = 0; j < around; ++j) {
            const double angle = j * std::numbers::pi / rings;
            mesh.positions.emplace_back(std::sin(polar) * std::cos(angle),
                                        std::sin(polar) * std::sin(angle), std::cos(polar));
        }
    }
    const auto north = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.emplace_back(0.0F, 0.0F, 1.0F);
    mesh.positions.emplace_back(0.0F, 0.0F, -1.0F);
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return i * around + j % around; };
    for (std::uint32_t j = 0; j < around; ++j) {
        mesh.triangles.emplace_back(north, at(0, j), at(0, j + 1));
        for (std::uint32_t i = 0; i + 2 < rings; ++i) {
            mesh.triangles.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
            mesh.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
        mesh.triangles.emplace_back(north + 1, at(rings - 2, j + 1), at(rings - 2, j));
    }
    return mesh;
}

/// The cap of a cylinder.
Mesh fan(std::uint32_t triangles) {
    Mesh mesh;
    mesh.positions.emplace_back(0.0F);
    for (std::uint32_t i = 0; i < triangles; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / triangles;
        mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0.0);
        mesh.triangles.emplace_back(0, 1 + i, 1 + (i + 1) % triangles);
    }
    return mesh;
}

void run(benchmark::State& state, const Mesh& mesh, unsigned threads) {
    ExecutionScope scope({.threads = threads});
    const double before = peak_bytes();
    for (auto _ : state) {
        DecimateOptions options;
        options.triangles = mesh.triangles.size() / 100;
        benchmark::DoNotOptimize(decimated(mesh, options));
    }
    const auto triangles = static_cast<double>(mesh.triangles.size());
    state.counters["bytes"] = (peak_bytes() - before) / triangles;
    state.counters["per_triangle"] = benchmark::Counter(
        triangles, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void decimate_torus(benchmark::State& state) {
    run(state, torus(static_cast<std::uint32_t>(state.range(0))),
        static_cast<unsigned>(state.range(1)));
}
void decimate_sphere(benchmark::State& state) {
    run(state, sphere(static_cast<std::uint32_t>(state.range(0))), 1);
}
void decimate_fan(benchmark::State& state) {
    run(state, fan(static_cast<std::uint32_t>(state.range(0))), 1);
}

BENCHMARK(decimate_torus)
    ->ArgNames({"cells", "threads"})
    ->Args({71, 1})
    ->Args({224, 1})
    ->Args({707, 1})
    ->Args({707, 2})
    ->Args({1414, 1})
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(decimate_sphere)->Arg(500)->Unit(benchmark::kMillisecond);
BENCHMARK(decimate_fan)->Arg(5'000)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

// Comparison of meshes.

constexpr std::uint32_t triangles_compared = 1'000'000;

Mesh framed_sphere() {
    Report report;
    return with_frames(bumpy_sphere(triangles_compared), {.tangents = TangentMethod::mikktspace},
                       report)
        .mesh;
}

Mesh fan_with_normals() {
    Mesh mesh = fan(triangles_compared);
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
    const Mesh mesh = framed_sphere();
    set_thread_limit(static_cast<unsigned>(state.range(0)));
    for (auto _ : state)
        benchmark::DoNotOptimize(identify_tangents(mesh));
    set_thread_limit(0);
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.triangles.size()));
}

#define RELIEF_ON_THREADS \
    ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond)

BENCHMARK_CAPTURE(compare, sphere_equal, framed_sphere, 0.0F)->RELIEF_ON_THREADS;
BENCHMARK_CAPTURE(compare, sphere_near, framed_sphere, 1e-6F)->RELIEF_ON_THREADS;
BENCHMARK_CAPTURE(compare, fan_equal, fan_with_normals, 0.0F)->RELIEF_ON_THREADS;
BENCHMARK_CAPTURE(compare, fan_near, fan_with_normals, 1e-8F)->RELIEF_ON_THREADS;
BENCHMARK(identify)->RELIEF_ON_THREADS;

// Diagnosis, for which the time per triangle should be similar for all shapes.

constexpr std::uint32_t triangles_diagnosed = 1'000'000;

Mesh bare_sphere() {
    return bumpy_sphere(triangles_diagnosed);
}

/// Adds a vertex on the unit circle, in space and in the image.
void add_on_circle(Mesh& mesh, std::uint32_t i, float height) {
    const double angle = 2.0 * std::numbers::pi * i / triangles_diagnosed;
    mesh.positions.emplace_back(std::cos(angle), std::sin(angle), height);
    mesh.texcoords.emplace_back(std::cos(angle), std::sin(angle));
}

/// All triangles share one vertex, in space and in the image.
Mesh textured_fan() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}};
    mesh.texcoords = {{0, 0}};
    for (std::uint32_t i = 0; i < triangles_diagnosed; ++i) {
        add_on_circle(mesh, i, 0.0F);
        mesh.triangles.emplace_back(0, i + 1, (i + 1) % triangles_diagnosed + 1);
    }
    return mesh;
}

/// All triangles share one edge.
Mesh book() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 0, 1}};
    mesh.texcoords = {{0, 0}, {0, 1}};
    for (std::uint32_t i = 0; i < triangles_diagnosed; ++i) {
        add_on_circle(mesh, i, 0.5F);
        mesh.triangles.emplace_back(0, 1, i + 2);
    }
    return mesh;
}

/// Triangles at random positions, each with the whole image.
Mesh soup() {
    Mesh mesh;
    std::mt19937 generator(1);
    std::uniform_real_distribution<float> anywhere(0.0F, 1.0F);
    const auto random = [&] {
        return glm::vec3(anywhere(generator), anywhere(generator), anywhere(generator));
    };
    for (std::uint32_t i = 0; i < triangles_diagnosed; ++i) {
        const glm::vec3 place = random();
        for (int k = 0; k < 3; ++k) {
            mesh.positions.push_back(place + 0.01F * random());
            mesh.texcoords.emplace_back(k == 1 ? 1.0F : 0.0F, k == 2 ? 1.0F : 0.0F);
        }
        mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    return mesh;
}

/// All vertices have the same position.
Mesh point() {
    Mesh mesh;
    mesh.positions.assign(triangles_diagnosed, glm::vec3(1, 2, 3));
    for (std::uint32_t i = 0; i < triangles_diagnosed; ++i)
        mesh.triangles.emplace_back(i, (i + 1) % triangles_diagnosed,
                                    (i + 2) % triangles_diagnosed);
    return mesh;
}

void diagnosis(benchmark::State& state, Mesh (*make)(), const DiagnoseOptions& options) {
    const Mesh mesh = make();
    set_thread_limit(static_cast<unsigned>(state.range(0)));
    for (auto _ : state)
        benchmark::DoNotOptimize(diagnose(mesh, options));
    set_thread_limit(0);
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.triangles.size()));
}

constexpr DiagnoseOptions least = {
    .edges = false, .near_duplicates = false, .texture_overlap = false};

DiagnoseOptions with(bool DiagnoseOptions::*part) {
    DiagnoseOptions options = least;
    options.*part = true;
    return options;
}

#define RELIEF_DIAGNOSIS(name, make, options)         \
    BENCHMARK_CAPTURE(diagnosis, name, make, options) \
        ->ArgName("threads")                          \
        ->Arg(1)                                      \
        ->Arg(2)                                      \
        ->UseRealTime()                               \
        ->Unit(benchmark::kMillisecond)

RELIEF_DIAGNOSIS(sphere_values, bare_sphere, least);
RELIEF_DIAGNOSIS(sphere_edges, bare_sphere, with(&DiagnoseOptions::edges));
RELIEF_DIAGNOSIS(sphere_near_duplicates, bare_sphere, with(&DiagnoseOptions::near_duplicates));
RELIEF_DIAGNOSIS(sphere_texture_overlap, bare_sphere, with(&DiagnoseOptions::texture_overlap));
RELIEF_DIAGNOSIS(bare_sphere, bare_sphere, DiagnoseOptions{});
RELIEF_DIAGNOSIS(textured_fan, textured_fan, DiagnoseOptions{});
RELIEF_DIAGNOSIS(book, book, DiagnoseOptions{});
RELIEF_DIAGNOSIS(soup, soup, DiagnoseOptions{});
RELIEF_DIAGNOSIS(point, point, DiagnoseOptions{});

// The memory bandwidth of one thread (McCalpin's triad), a lower bound for all other times.

void memory_triad(benchmark::State& state) {
    const std::size_t count = std::size_t{1} << 25;  // 3 x 128 MiB, larger than any cache
    std::vector<float> a(count, 0.0F);
    const std::vector<float> b(count, 1.0F);
    const std::vector<float> c(count, 2.0F);
    for (auto _ : state) {
        for (std::size_t i = 0; i < count; ++i)
            a[i] = b[i] + 3.0F * c[i];
        benchmark::DoNotOptimize(a.data());
        benchmark::ClobberMemory();
    }
    state.SetBytesProcessed(state.iterations() *
                            static_cast<std::int64_t>(3 * count * sizeof(float)));
}
BENCHMARK(memory_triad)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relief::bench
