// SPDX-License-Identifier: Apache-2.0
#include "relief/mesh/bump.h"

#include <benchmark/benchmark.h>

#include <cmath>

#include "relief/mesh/threads.h"

namespace relief::bench {
namespace {

/// A tiling field of a few waves in both directions.
Image waves(int size) {
    Image field = make_image(size, size, 1, 32, ColorSpace::data);
    const auto heights = field.as<float>();
    const double step = 6.283185307179586 / size;
    for (int row = 0; row < size; ++row) {
        for (int column = 0; column < size; ++column) {
            heights[static_cast<std::size_t>(row) * static_cast<std::size_t>(size) +
                    static_cast<std::size_t>(column)] =
                static_cast<float>(0.5 + 0.25 * std::sin(9 * step * column) +
                                   0.25 * std::cos(7 * step * row));
        }
    }
    return field;
}

void bump_normals(benchmark::State& state, Kernel kernel) {
    const Image field = waves(static_cast<int>(state.range(0)));
    set_thread_limit(static_cast<unsigned>(state.range(1)));
    for (auto _ : state) {
        Report report;
        benchmark::DoNotOptimize(normals_from_height(field, {.kernel = kernel}, report));
    }
    set_thread_limit(0);
    state.SetItemsProcessed(state.iterations() * state.range(0) * state.range(0));
}
BENCHMARK_CAPTURE(bump_normals, central3, Kernel::central3)
    ->ArgNames({"size", "threads"})
    ->ArgsProduct({{4096}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(bump_normals, sobel3, Kernel::sobel3)
    ->ArgNames({"size", "threads"})
    ->ArgsProduct({{4096}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relief::bench
