// SPDX-License-Identifier: Apache-2.0
// Tests: tests/mesh/base/thread_pool_test.cpp.
#include "thread_pool.h"

#include <algorithm>
#include <atomic>
#include <system_error>

namespace relief::detail {

struct ThreadPool::Loop {
    const std::function<void(std::size_t, std::size_t)>& run_piece;
    std::size_t count;
    std::size_t step;
    std::atomic<std::size_t> next = 0;
    std::size_t helpers = 0;

    [[nodiscard]] bool is_taken() const { return next.load() >= count; }

    void run_pieces() {
        for (std::size_t begin = next.fetch_add(step); begin < count; begin = next.fetch_add(step))
            run_piece(begin, std::min(begin + step, count));
    }
};

ThreadPool::~ThreadPool() {
    {
        const std::lock_guard lock(mutex_);
        is_ending_ = true;
    }
    has_work_.notify_all();
    for (std::thread& thread : threads_)
        thread.join();
}

void ThreadPool::run(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t, std::size_t)>& run_piece) {
    constexpr std::size_t pieces_per_thread = 8;
    const std::size_t threads = limit();
    Loop loop{run_piece, count,
              std::max({grain, count / (pieces_per_thread * threads), std::size_t{1}})};
    if (threads == 1 || count <= loop.step) return loop.run_pieces();
    {
        const std::lock_guard lock(mutex_);
        start_threads();
        loops_.push_back(&loop);
    }
    has_work_.notify_all();
    loop.run_pieces();
    std::unique_lock lock(mutex_);
    std::erase(loops_, &loop);
    helper_left_.wait(lock, [&] { return loop.helpers == 0; });
}

std::size_t ThreadPool::limit() const {
    const std::lock_guard lock(mutex_);
    return limit_while_locked();
}

std::size_t ThreadPool::limit_while_locked() const {
    const std::size_t processors = std::max(std::thread::hardware_concurrency(), 1U);
    return limit_ == 0 ? processors : std::min(limit_, processors);
}

void ThreadPool::set_limit(std::size_t count) {
    const std::lock_guard lock(mutex_);
    limit_ = count;
}

/// A thread that cannot be started is not needed: the calling thread runs its pieces.
void ThreadPool::start_threads() {
    try {
        while (threads_.size() + 1 < limit_while_locked())
            threads_.emplace_back([this] { work(); });
    } catch (const std::system_error&) {
    }
}

ThreadPool::Loop* ThreadPool::loop_to_join() const {
    if (helpers_ + 1 >= limit_while_locked()) return nullptr;
    const auto open = std::find_if(loops_.begin(), loops_.end(),
                                   [](const Loop* loop) { return !loop->is_taken(); });
    return open == loops_.end() ? nullptr : *open;
}

void ThreadPool::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        Loop* loop = nullptr;
        has_work_.wait(lock, [&] { return is_ending_ || (loop = loop_to_join()) != nullptr; });
        if (loop == nullptr) return;
        ++loop->helpers;
        ++helpers_;
        lock.unlock();
        loop->run_pieces();
        lock.lock();
        --helpers_;
        if (--loop->helpers == 0) helper_left_.notify_all();
    }
}

}  // namespace relief::detail
