// SPDX-License-Identifier: Apache-2.0
#include "relief/mesh/tangents.h"

#include <benchmark/benchmark.h>

#include "mesh/bumpy_sphere.h"
#include "relief/mesh/threads.h"

namespace relief::bench {
namespace {

void tangents_mikktspace(benchmark::State& state) {
    const Mesh mesh = bumpy_sphere(static_cast<std::size_t>(state.range(0)));
    set_thread_limit(static_cast<unsigned>(state.range(1)));
    for (auto _ : state) {
        Report report;
        benchmark::DoNotOptimize(mikktspace_tangents(mesh.positions, mesh.normals, mesh.texcoords,
                                                     mesh.triangles, report));
    }
    set_thread_limit(0);
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.triangles.size()));
}
BENCHMARK(tangents_mikktspace)
    ->ArgNames({"triangles", "threads"})
    ->ArgsProduct({{100'000, 1'000'000}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relief::bench
