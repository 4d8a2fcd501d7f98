// SPDX-License-Identifier: Apache-2.0
// Interleaved rounds, thread limits and memory. No test depends on a measured time.
#include "relief/accuracy/measure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <ctime>
#include <thread>

namespace relief {
namespace {

using testing::SizeIs;

RunOptions rounds(std::size_t counted) {
    RunOptions options;
    options.repeats = {counted, 1};
    return options;
}

TEST(MeasureCosts, TakesTurnsAndCountsTheRoundsAskedFor) {
    std::string calls;
    const auto slow = [&](char name) {
        return [&calls, name] {
            calls += name;
            const std::clock_t begin = std::clock();
            while (std::clock() - begin < 5 * CLOCKS_PER_SEC / 1000) {
            }
        };
    };
    const std::vector<std::function<void()>> works = {slow('a'), slow('b')};
    const std::vector<Cost> costs = measure_costs(
        works, rounds(3), {.one_thread = true, .all_threads = false, .memory = false});
    ASSERT_THAT(costs, SizeIs(2));
    EXPECT_THAT(costs[0].one_thread.value().rounds, SizeIs(3));
    // Allow for the difference of two clocks.
    EXPECT_GE(costs[1].one_thread.value().spread().median, 4.9e-3);
    EXPECT_FALSE(costs[0].all_threads);
    EXPECT_FALSE(costs[0].peak_bytes);
    // Each work runs once to warm up and once to estimate its time; then one round is not counted.
    EXPECT_EQ(calls,
              "aabb"
              "ab"
              "ababab");
}

TEST(MeasureCosts, RepeatsShortWorkWithinARound) {
    std::size_t calls = 0;
    const std::vector<std::function<void()>> works = {[&] { ++calls; }};
    const std::vector<Cost> costs = measure_costs(
        works, rounds(2), {.one_thread = true, .all_threads = false, .memory = false});
    EXPECT_GT(calls, 2U + 3U * 10U);     // More than ten per round,
    EXPECT_LE(calls, 2U + 3U * 40000U);  // and no more than a working clock can demand.
    EXPECT_LT(costs[0].one_thread.value().spread().p10, 1e-3);  // The time of one call.
}

TEST(MeasureCosts, OneThreadsTimeIsThatOfTheProcessor) {
    // Waiting costs no processor time, just as time that other programs use.
    const std::vector<std::function<void()>> works = {
        [] { std::this_thread::sleep_for(std::chrono::milliseconds(20)); }};
    const std::vector<Cost> costs =
        measure_costs(works, rounds(3), {.one_thread = true, .all_threads = true, .memory = false});
    EXPECT_LT(costs[0].one_thread.value().spread().p10, 10e-3);
    EXPECT_GT(costs[0].one_thread.value().spread().p10, 0.0);
    EXPECT_GE(costs[0].all_threads.value().spread().p10, 20e-3);
}

TEST(MeasureCosts, WithoutTimesMeasuresNothing) {
    RunOptions options;
    options.is_timed = false;
    const std::vector<std::function<void()>> works = {[] { FAIL(); }};
    const std::vector<Cost> costs = measure_costs(works, options);
    EXPECT_EQ(costs, std::vector<Cost>(1));
}

TEST(PeakBytes, AreWhatWorkHoldsAtTheMost) {
    constexpr std::size_t size = 64U << 20U;
    const auto touch = [] {
        std::vector<char> memory(size);
        for (std::size_t i = 0; i < size; i += 512)
            memory[i] = static_cast<char>(i);
        volatile const char* kept = memory.data();
        EXPECT_EQ(kept[512], static_cast<char>(512));
    };
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
