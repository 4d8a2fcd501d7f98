// SPDX-License-Identifier: Apache-2.0
/// \file
/// Threads of the standard library that share loops, for builds without oneTBB.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "relief/export.h"

namespace RELIEF_API relief {
namespace detail {

/// A loop is shared by the calling thread and by the idle threads of the pool. The calling thread
/// runs pieces until none is left, so nested loops and loops on several calling threads always
/// advance, even if the system provides no further thread. Threads start with the first loop.
class ThreadPool {
  public:
    ThreadPool() = default;
    /// No loop may run.
    ~ThreadPool();
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    /// Like run_on_threads().
    void run(std::size_t count, std::size_t grain,
             const std::function<void(std::size_t, std::size_t)>& run_piece);

    /// Returns the number of threads of a loop.
    [[nodiscard]] std::size_t limit() const;
    /// \param count  beyond the number of processors: their number; 0: their number
    void set_limit(std::size_t count);

  private:
    struct Loop;

    [[nodiscard]] std::size_t limit_while_locked() const;
    void start_threads();
    void work();
    [[nodiscard]] Loop* loop_to_join() const;

    mutable std::mutex mutex_;  ///< Protects all members, and Loop::helpers.
    std::condition_variable has_work_;
    std::condition_variable helper_left_;
    std::vector<std::thread> threads_;
    std::vector<Loop*> loops_;
    std::size_t limit_ = 0;
    std::size_t helpers_ = 0;  ///< Threads of the pool that run pieces.
    bool is_ending_ = false;
};

}  // namespace detail
}  // namespace relief
