// SPDX-License-Identifier: Apache-2.0
// Loops on threads of the standard library, which builds without oneTBB use.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <set>
#include <thread>
#include <vector>

#include "thread_pool.h"

namespace relief {
using namespace relief::detail;

namespace {

TEST(ThreadPool, VisitsEveryElementOnce) {
    ThreadPool pool;
    for (const std::size_t limit : {1U, 2U, 0U}) {
        pool.set_limit(limit);
        for (const std::size_t count : {1U, 99U, 100000U}) {
            std::vector<int> visits(count, 0);
            std::atomic<std::size_t> smallest = count;
            pool.run(count, 100, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i)
                    ++visits[i];
                if (end < count && end - begin < smallest) smallest = end - begin;
            });
            EXPECT_THAT(visits, testing::Each(1)) << limit << " threads";
            EXPECT_GE(smallest, std::min<std::size_t>(count, 100));
        }
    }
}

TEST(ThreadPool, SharesALoopAmongItsThreads) {
    ThreadPool pool;
    if (pool.limit() == 1) GTEST_SKIP() << "needs two processors";
    std::atomic<std::size_t> running = 0;
    std::atomic<bool> are_two = false;
    // The first piece waits until another thread has begun the second one.
    pool.run(2, 1, [&](std::size_t, std::size_t) {
        if (++running == 2) are_two = true;
        for (int i = 0; i < 10000 && !are_two; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    });
    EXPECT_TRUE(are_two);
}

TEST(ThreadPool, NestedLoopsOfSeveralThreadsEnd) {
    ThreadPool pool;
    std::atomic<std::size_t> visits = 0;
    const auto nested = [&] {
        for (int round = 0; round < 20; ++round) {
            pool.run(10, 1, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                    pool.run(50, 1, [&](std::size_t first, std::size_t last) {
                        pool.run(last - first, 1,
                                 [&](std::size_t from, std::size_t to) { visits += to - from; });
                    });
                }
            });
        }
    };
    std::thread one(nested);
    std::thread other(nested);
    nested();
    one.join();
    other.join();
    EXPECT_EQ(visits, 3U * 20U * 10U * 50U);
}

TEST(ThreadPool, ALimitOfOneStaysOnTheCallingThread) {
    ThreadPool pool;
    pool.set_limit(1);
    EXPECT_EQ(pool.limit(), 1U);
    std::set<std::thread::id> threads;
    pool.run(1000, 1,
             [&](std::size_t, std::size_t) { threads.insert(std::this_thread::get_id()); });
    EXPECT_THAT(threads, testing::ElementsAre(std::this_thread::get_id()));
}

TEST(ThreadPool, TheLimitIsAtMostTheNumberOfProcessors) {
    ThreadPool pool;
    const std::size_t processors = pool.limit();
    pool.set_limit(processors + 1);
    EXPECT_EQ(pool.limit(), processors);
}

}  // namespace
}  // namespace relief
