// SPDX-License-Identifier: Apache-2.0
#include "parallel.h"

#include <algorithm>
#include <exception>
#include <functional>
#include <limits>
#include <mutex>
#include <utility>

#include "file_replacement.h"
#include "progress_stage.h"
#include "relief/mesh/execution.h"
#include "threads.h"
#include "work_array.h"

namespace relief {
using namespace relief::detail;

constinit std::atomic<void (*)()> detail::before_each_piece = nullptr;

namespace {

/// The exception of the failed piece with the smallest index.
class FirstFailure {
  public:
    /// Returns true if a piece before this one has failed, so that this one cannot affect the
    /// result.
    [[nodiscard]] bool is_before(std::size_t piece) const {
        return piece_.load(std::memory_order_relaxed) < piece;
    }

    void set(std::size_t piece, std::exception_ptr exception) {
        const std::lock_guard lock(mutex_);
        if (exception_ && piece_ < piece) return;
        piece_ = piece;
        exception_ = std::move(exception);
    }

    /// Call this after the loop. \throws the exception, if there is one
    void rethrow() {
        if (exception_) std::rethrow_exception(std::move(exception_));
    }

  private:
    std::atomic<std::size_t> piece_ = std::numeric_limits<std::size_t>::max();
    std::mutex mutex_;
    std::exception_ptr exception_;
};

void call_hook() {
    if (void (*const hook)() = before_each_piece.load(std::memory_order_relaxed)) hook();
}

/// Runs the pieces on at most `threads` threads: each of them takes the next piece until none is
/// left. The loops in the pieces share the limit.
template <typename RunPiece>
void take_pieces(unsigned threads, std::size_t count, std::size_t grain,
                 const RunPiece& run_piece) {
    constexpr std::size_t pieces_per_thread = 8;
    const std::size_t step = std::max(grain, count / (pieces_per_thread * threads));
    const std::size_t takers = std::min<std::size_t>(threads, (count + step - 1) / step);
    std::atomic<std::size_t> next = 0;
    run_on_threads(takers, 1, [&](std::size_t, std::size_t) {
        const unsigned before =
            std::exchange(current_thread_limit, threads / static_cast<unsigned>(takers));
        for (std::size_t begin = next.fetch_add(step); begin < count; begin = next.fetch_add(step))
            run_piece(begin, std::min(begin + step, count));
        current_thread_limit = before;
    });
}

/// Runs the pieces on all threads, or within the limit of this operation.
///
/// After an exception oneTBB would cancel the loop and all nested loops, which would then return
/// normally although some of their pieces never ran. Each exception is therefore caught in its
/// piece.
template <typename RunPiece>
void run_pieces(std::size_t count, std::size_t grain, const RunPiece& run_piece) {
    if (current_thread_limit == 1) return run_piece(0, count);
    FirstFailure failure;
    Workspace* const workspace = current_workspace;
    FileSet* const file_set = current_file_set;
    const auto run_and_catch = [&](std::size_t begin, std::size_t end) {
        Workspace* const before = std::exchange(current_workspace, workspace);
        FileSet* const set_before = std::exchange(current_file_set, file_set);
        if (!failure.is_before(begin)) {
            try {
                run_piece(begin, end);
            } catch (...) {
                failure.set(begin, std::current_exception());
            }
        }
        current_workspace = before;
        current_file_set = set_before;
    };
    if (current_thread_limit > 0)
        take_pieces(current_thread_limit, count, grain, run_and_catch);
    else
        run_on_threads(count, grain, std::ref(run_and_catch));
    failure.rethrow();
}

/// Runs pieces that are small enough to react to cancellation quickly.
void parallel_for_with_progress(std::size_t count, std::size_t grain, Progress* progress,
                                const std::function<void(std::size_t, std::size_t)>& body) {
    constexpr std::size_t checks = 256;  // The checks of a 2 s loop on one thread are 8 ms apart.
    const std::size_t step = std::max(grain, count / checks);
    const auto run_piece = [&](std::size_t first, std::size_t last) {
        const ProgressPiece piece(progress);
        for (std::size_t begin = first; begin < last; begin += step) {
            call_hook();
            check_cancelled();
            body(begin, std::min(begin + step, last));
        }
    };
    check_cancelled();
    if (count <= grain) return run_piece(0, count);
    run_pieces(count, grain, run_piece);
}

}  // namespace

void detail::parallel_for(std::size_t count, std::size_t grain,
                          const std::function<void(std::size_t, std::size_t)>& body) {
    if (count == 0) return;
    if (current_progress != nullptr)
        return parallel_for_with_progress(count, grain, current_progress, body);
    const auto run_piece = [&](std::size_t begin, std::size_t end) {
        call_hook();
        body(begin, end);
    };
    // Loops of one piece run here, so that programs with only such loops never start threads.
    if (count <= grain) return run_piece(0, count);
    run_pieces(count, grain, run_piece);
}

void detail::parallel_for_reporting(
    std::size_t count, std::size_t grain, Report& report,
    const std::function<void(std::size_t, std::size_t, Report&)>& body) {
    std::vector<Report> found((count + grain - 1) / grain);
    parallel_for(found.size(), 1, [&](std::size_t first, std::size_t last) {
        for (std::size_t piece = first; piece < last; ++piece)
            body(piece * grain, std::min(count, (piece + 1) * grain), found[piece]);
    });
    for (const Report& one : found)
        report.merge(one);
}

std::size_t detail::thread_count() {
    // The limits of this operation and of set_thread_limit(), or the number of processors. This
    // call starts no threads.
    if (current_thread_limit > 0) return current_thread_limit;
    return thread_limit();
}

void detail::parallel_tasks(const std::vector<std::function<void()>>& tasks, bool are_small) {
    std::vector<std::exception_ptr> failures(tasks.size());
    parallel_for(tasks.size(), are_small ? tasks.size() : 1,
                 [&](std::size_t begin, std::size_t end) {
                     for (std::size_t i = begin; i < end; ++i) {
                         try {
                             tasks[i]();
                         } catch (...) {
                             failures[i] = std::current_exception();
                         }
                     }
                 });
    for (const std::exception_ptr& failure : failures) {
        if (failure) std::rethrow_exception(failure);
    }
}

}  // namespace relief
