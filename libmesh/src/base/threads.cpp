// SPDX-License-Identifier: Apache-2.0
// The only file that uses oneTBB. Its inline functions make this file special for ThreadSanitizer
// (base/CMakeLists.txt).
#include "threads.h"

#include "relief/mesh/execution.h"

#if RELIEF_TBB

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>
#include <mutex>

#ifdef RELIEF_TSAN
#include <sanitizer/tsan_interface.h>
#endif

namespace relief {
namespace {

// oneTBB is not instrumented for ThreadSanitizer, which thus does not see that a loop's pieces run
// between the loop's begin and end. These two functions declare it. This file, which has inline
// functions of oneTBB, is not instrumented either.
void release_writes([[maybe_unused]] void* loop) {
#ifdef RELIEF_TSAN
    __tsan_release(loop);
#endif
}

void acquire_writes([[maybe_unused]] void* loop) {
#ifdef RELIEF_TSAN
    __tsan_acquire(loop);
#endif
}

}  // namespace

/// The isolated context prevents cancellation by oneTBB tasks of the caller.
void detail::run_on_threads(std::size_t count, std::size_t grain,
                            const std::function<void(std::size_t, std::size_t)>& run_piece) {
    tbb::task_group_context context(tbb::task_group_context::isolated);
    release_writes(&context);
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, grain),
        [&](const auto& piece) {
            acquire_writes(&context);
            run_piece(piece.begin(), piece.end());
            release_writes(&context);
        },
        context);
    acquire_writes(&context);
}

std::size_t detail::thread_limit() {
    const auto limit =
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    return std::min<std::size_t>(
        limit, static_cast<std::size_t>(std::max(tbb::info::default_concurrency(), 1)));
}

void set_thread_limit(unsigned count) {
    static std::mutex mutex;
    static std::unique_ptr<tbb::global_control> limit;
    const std::lock_guard lock(mutex);
    limit.reset();
    if (count > 0) {
        limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                      count);
    }
}

}  // namespace relief

#else

#include "thread_pool.h"

namespace relief {
namespace {

/// It is never destroyed, because threads of the program may use it until its end.
detail::ThreadPool& pool() {
    static auto* const all = new detail::ThreadPool;
    return *all;
}

}  // namespace

void detail::run_on_threads(std::size_t count, std::size_t grain,
                            const std::function<void(std::size_t, std::size_t)>& run_piece) {
    pool().run(count, grain, run_piece);
}

std::size_t detail::thread_limit() {
    return pool().limit();
}

void set_thread_limit(unsigned count) {
    pool().set_limit(count);
}

}  // namespace relief

#endif
