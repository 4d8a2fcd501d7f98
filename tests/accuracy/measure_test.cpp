// SPDX-License-Identifier: Apache-2.0
// Clocks, repeats and memory.
#include "experiment_driver.h"

#include <gtest/gtest.h>

#include <chrono>
#include <ctime>
#include <thread>
#include <vector>

namespace relief {
using namespace relief::accuracy::detail;

namespace {

TEST(RepeatsPerRound, MakeARoundLongEnoughToMeasure) {
    std::size_t calls = 0;
    const std::size_t repeats = repeats_per_round([&] { ++calls; });
    EXPECT_EQ(calls, 1U);
    EXPECT_GT(repeats, 10U);
    EXPECT_LE(repeats, 40000U) << "no more than a working clock can demand";
    EXPECT_EQ(repeats_per_round([] { std::this_thread::sleep_for(std::chrono::milliseconds(5)); }),
              1U);
}

TEST(ProcessorSeconds, ExcludeTimeOfWaiting) {
    // Waiting costs no processor time, just as time that other programs use.
    const double waiting =
        processor_seconds_of([] { std::this_thread::sleep_for(std::chrono::milliseconds(20)); });
    EXPECT_GT(waiting, 0.0);
    EXPECT_LT(waiting, 10e-3);
    const double working = processor_seconds_of([] {
        const std::clock_t begin = std::clock();
        while (std::clock() - begin < 5 * CLOCKS_PER_SEC / 1000) {
        }
    });
    EXPECT_GE(working, 4.9e-3);  // Allow for the difference of two clocks.
}

TEST(PeakBytes, AreTheMaximumAllocated) {
    constexpr std::size_t size = 64U << 20U;
    const auto touch = [] {
        std::vector<char> memory(size);
        for (std::size_t i = 0; i < size; i += 512)
            memory[i] = static_cast<char>(i);
        volatile const char* kept = memory.data();
        EXPECT_EQ(kept[512], static_cast<char>(512));
    };
#ifdef __SANITIZE_THREAD__
    GTEST_SKIP() << "the process also holds the memory of ThreadSanitizer";
#endif
    const std::optional<std::uint64_t> one = peak_bytes_of(touch);
    if (!one) GTEST_SKIP() << "this system does not tell what a process holds";
    EXPECT_GE(*one, size * 9 / 10);
    EXPECT_LE(peak_bytes_of([] {}).value(), size / 10);
#ifndef __SANITIZE_ADDRESS__  // AddressSanitizer keeps freed memory.
    EXPECT_LE(peak_bytes_of([&] { touch(), touch(); }).value(), size * 11 / 10);
#endif
}

}  // namespace
}  // namespace relief
