// SPDX-License-Identifier: Apache-2.0
// Decimation per triangle: shapes of growing size, and shapes on which simple algorithms need
// quadratic time. The counter bytes is the growth of the peak memory of the process per triangle,
// so it is meaningful only for the first benchmark of a run: select one with --benchmark_filter.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>

#include "relief/mesh/execution.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/topology.h"

namespace relief {
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

}  // namespace
}  // namespace relief
