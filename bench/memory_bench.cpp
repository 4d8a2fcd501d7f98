// SPDX-License-Identifier: Apache-2.0
// The memory bandwidth of one thread (McCalpin's triad), a lower bound for all other times.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <vector>

namespace {

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
