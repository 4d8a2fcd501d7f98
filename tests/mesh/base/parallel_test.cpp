// SPDX-License-Identifier: Apache-2.0
// Parallel loops: every element once, whatever the number of threads, and exceptions come through.
#include "parallel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
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

/// Piece 1 of two fails while piece 0 is at work.
struct FailureBeside {
    std::atomic<bool> has_begun = false;
    std::atomic<bool> has_failed = false;

    /// For piece 0. Returns some time after the failure.
    void wait_for_failure() {
        has_begun = true;
        if (wait_for(has_failed)) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    /// For piece 1.
    [[noreturn]] void fail() {
        wait_for(has_begun);
        has_failed = true;
        throw std::runtime_error("piece 1");
    }

  private:
    /// Gives up where one thread does everything.
    static bool wait_for(const std::atomic<bool>& event) {
        for (int i = 0; i < 2000 && !event; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return event;
    }
};

TEST(Parallel, AFailureEndsNoLoopOfAnotherPiece) {
    if (thread_count() == 1) GTEST_SKIP() << "needs two threads";
    FailureBeside beside;
    std::atomic<std::size_t> done = 0;
    std::size_t done_at_return = 0;
    const auto run = [&] {
        parallel_for(2, 1, [&](std::size_t begin, std::size_t end) {
            if (begin == 0) {
                parallel_for(1000, 1, [&](std::size_t first, std::size_t last) {
                    if (first == 0) beside.wait_for_failure();
                    done += last - first;
                });
                done_at_return = done;
            }
            if (end == 2) beside.fail();
        });
    };
    EXPECT_THAT(run, testing::ThrowsMessage<std::runtime_error>("piece 1"));
    EXPECT_EQ(done_at_return, 1000U);
}

TEST(Parallel, ACallersTasksThatAreCancelledEndNoLoop) {
#ifdef __SANITIZE_THREAD__
    GTEST_SKIP() << "oneTBB's inline functions and its library are not both instrumented";
#endif
    for (int i = 0; i < 50; ++i) {
        tbb::task_group_context context;
        tbb::parallel_for(
            tbb::blocked_range<int>(0, 4, 1),
            [&](const auto&) {
                std::atomic<std::size_t> done = 0;
                parallel_for(1000, 1, [&](std::size_t first, std::size_t last) {
                    done += last - first;
                    context.cancel_group_execution();
                });
                EXPECT_EQ(done, 1000U);
            },
            context);
    }
}

TEST(Parallel, OfSeveralExceptionsThatOfTheFirstPieceReachesTheCaller) {
    if (thread_count() == 1) GTEST_SKIP() << "needs two threads";
    FailureBeside beside;
    const auto run = [&] {
        parallel_for(2, 1, [&](std::size_t begin, std::size_t end) {
            if (begin == 0) {
                beside.wait_for_failure();
                throw std::runtime_error("piece 0");
            }
            if (end == 2) beside.fail();
        });
    };
    EXPECT_THAT(run, testing::ThrowsMessage<std::runtime_error>("piece 0"));
}

TEST(Parallel, EveryPieceBeforeTheFirstFailureRuns) {
    for (const unsigned threads : {1U, 2U, 0U}) {
        set_thread_limit(threads);
        std::vector<int> visits(10000, 0);
        const auto run = [&] {
            parallel_for(visits.size(), 1, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                    if (i % 1000 == 999) throw std::runtime_error(std::to_string(i));
                    ++visits[i];
                }
            });
        };
        EXPECT_THAT(run, testing::ThrowsMessage<std::runtime_error>("999"));
        EXPECT_EQ(std::count(visits.begin(), visits.begin() + 999, 1), 999);
    }
    set_thread_limit(0);
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
