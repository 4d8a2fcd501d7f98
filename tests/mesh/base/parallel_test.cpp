// SPDX-License-Identifier: Apache-2.0
// Parallel loops visit every element once, within their limits of threads. A failure or
// cancellation in any piece reaches the caller.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "parallel.h"
#include "progress_stage.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/report.h"
#include "relief/mesh/tangents.h"
#include "support/invariants.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::detail;

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

/// Runs nested loops, whose pieces wait for each other for a moment, and returns how many threads
/// worked in them at the same time at most.
std::size_t threads_at_once(const ExecutionOptions& execution) {
    const ExecutionScope scope(execution);
    std::atomic<std::size_t> working = 0;
    std::atomic<std::size_t> most = 0;
    parallel_for(8, 1, [&](std::size_t, std::size_t) {
        parallel_for(8, 1, [&](std::size_t, std::size_t) {
            const std::size_t now = ++working;
            for (std::size_t seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            --working;
        });
    });
    return most;
}

TEST(Execution, LimitsOfThreadsApplyToTheirOperationsAlone) {
    set_thread_limit(0);
    std::size_t alone = 0;
    std::thread other([&] {
        for (int round = 0; round < 5; ++round)
            alone = std::max(alone, threads_at_once({.threads = 1}));
    });
    // On a busy machine the second thread may come late.
    const std::size_t wanted = std::min<std::size_t>(2, thread_count());
    std::size_t together = 0;
    for (int round = 0; round < 5 || (together < wanted && round < 500); ++round)
        together = std::max(together, threads_at_once({.threads = 2}));
    other.join();
    EXPECT_EQ(alone, 1U);
    EXPECT_EQ(together, wanted);
}

TEST(Execution, TheSmallestLimitOfNestedScopesApplies) {
    const std::size_t all = thread_count();
    const ExecutionScope outer({.threads = 1});
    EXPECT_EQ(thread_count(), 1U);
    {
        const ExecutionScope inner({.threads = 64});
        EXPECT_EQ(thread_count(), 1U);
    }
    std::thread([&] { EXPECT_EQ(thread_count(), all); }).join();
}

TEST(Execution, OperationsWithDifferentLimitsGiveTheSameBits) {
    const Mesh mesh = test::sphere(200, 150);
    const auto normals_with = [&](const ExecutionOptions& execution) {
        std::vector<glm::vec3> normals(mesh.positions.size());
        vertex_normals(mesh.positions, mesh.triangles, {}, normals, IgnoredReport(), execution);
        return normals;
    };
    const auto tangents_with = [&](const ExecutionOptions& execution) {
        std::vector<glm::vec4> tangents(mesh.positions.size());
        vertex_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, tangents,
                        IgnoredReport(), execution);
        return tangents;
    };
    std::vector<glm::vec3> normals;
    std::vector<glm::vec4> tangents;
    std::thread other([&] {
        normals = normals_with({.threads = 1});
        tangents = tangents_with({.threads = 2});
    });
    EXPECT_TRUE(test::same_bits(tangents_with({.threads = 1}), tangents_with({})));
    EXPECT_TRUE(test::same_bits(normals_with({.threads = 2}), normals_with({})));
    other.join();
    EXPECT_TRUE(test::same_bits(normals, normals_with({})));
    EXPECT_TRUE(test::same_bits(tangents, tangents_with({})));
}

TEST(Execution, ACancelledOperationThrows) {
    const Mesh mesh = test::sphere(20, 15);
    Progress progress;
    progress.cancel();
    std::vector<glm::vec3> normals(mesh.positions.size());
    EXPECT_THROW(vertex_normals(mesh.positions, mesh.triangles, {}, normals, IgnoredReport(),
                                {.threads = 1, .progress = &progress}),
                 Cancelled);
    EXPECT_NO_THROW(check_cancelled());
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

/// Piece 1 of two fails while piece 0 is still running.
struct FailureBeside {
    std::atomic<bool> has_begun = false;
    std::atomic<bool> has_failed = false;

    /// Piece 0 calls it. It returns some time after the failure.
    void wait_for_failure() {
        has_begun = true;
        if (wait_for(has_failed)) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    /// Piece 1 calls it.
    [[noreturn]] void fail() {
        wait_for(has_begun);
        has_failed = true;
        throw std::runtime_error("piece 1");
    }

  private:
    /// Returns without waiting if only one thread exists.
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

TEST(Parallel, ThrowsTheExceptionOfTheFirstPiece) {
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
