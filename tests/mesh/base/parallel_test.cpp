// SPDX-License-Identifier: Apache-2.0
// Parallel loops: every element once, whatever the number of threads, and exceptions come through.
#include "parallel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "relief/mesh/threads.h"

namespace relief {
namespace {

TEST(Parallel, EveryElementIsVisitedOnce) {
    for (const unsigned threads : {1U, 2U, 0U}) {
        set_thread_limit(threads);
        for (const std::size_t count : {0U, 1U, 99U, 100000U}) {
            std::vector<int> visits(count, 0);
            parallel_for(count, 100, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i)
                    ++visits[i];
            });
            EXPECT_THAT(visits, testing::Each(1)) << threads << " threads";
        }
    }
}

TEST(Parallel, FindingsComeInTheOrderOfThePieces) {
    const auto found = [](unsigned threads) {
        set_thread_limit(threads);
        Report report;
        parallel_for_reporting(1001, 10, report, [](std::size_t begin, std::size_t end, Report& r) {
            for (std::size_t i = begin; i < end; ++i)
                r.add(i % 7 == 3 ? "one" : "other", "thing", i, "counted");
        });
        set_thread_limit(0);
        return report;
    };
    const Report alone = found(1);
    ASSERT_EQ(alone.findings().size(), 2U);
    EXPECT_EQ(alone.findings()[0].kind, "other");
    EXPECT_EQ(alone.count("one"), 143U);
    EXPECT_EQ(alone.count("other"), 858U);
    const Report together = found(0);
    EXPECT_TRUE(std::equal(alone.findings().begin(), alone.findings().end(),
                           together.findings().begin(), together.findings().end()));
}

TEST(Parallel, AnExceptionReachesTheCaller) {
    EXPECT_THROW(parallel_for(1000, 1,
                              [](std::size_t begin, std::size_t end) {
                                  if (begin <= 500 && 500 < end) throw std::runtime_error("at 500");
                              }),
                 std::runtime_error);
}

TEST(Parallel, TasksAllRunAndTheFirstThatThrowsIsHeard) {
    for (const bool are_small : {true, false}) {
        std::vector<int> runs(4, 0);
        const auto fail = [](const char* what) { throw std::runtime_error(what); };
        const std::vector<std::function<void()>> tasks{
            [&] { ++runs[0]; }, [&] { ++runs[1], fail("one"); }, [&] { ++runs[2], fail("two"); },
            [&] { ++runs[3]; }};
        EXPECT_THAT([&] { parallel_tasks(tasks, are_small); },
                    testing::ThrowsMessage<std::runtime_error>("one"));
        EXPECT_THAT(runs, testing::Each(1));
    }
}

}  // namespace
}  // namespace relief
