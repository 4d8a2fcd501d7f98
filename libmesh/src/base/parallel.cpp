// SPDX-License-Identifier: Apache-2.0
#include "parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <exception>
#include <memory>

#include "progress_stage.h"
#include "relief/mesh/threads.h"

namespace relief {
namespace {

/// In pieces so small that somebody who wants the work to end is heard soon.
void parallel_for_watched(std::size_t count, std::size_t grain, Progress* progress,
                          const std::function<void(std::size_t, std::size_t)>& body) {
    constexpr std::size_t looks = 256;  // 2 s of work are 8 ms apart on one thread.
    const std::size_t step = std::max(grain, count / looks);
    check_cancelled();
    if (count <= grain) {
        const ProgressPiece piece(progress);
        return body(0, count);
    }
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), [&](const auto& range) {
        const ProgressPiece piece(progress);
        for (std::size_t begin = range.begin(); begin < range.end(); begin += step) {
            check_cancelled();
            body(begin, std::min(begin + step, range.end()));
        }
    });
}

}  // namespace

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) {
    if (count == 0) return;
    if (current_progress != nullptr)
        return parallel_for_watched(count, grain, current_progress, body);
    // Nothing to share out: a program that never has more than this never starts oneTBB.
    if (count <= grain) return body(0, count);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                      [&](const auto& piece) { body(piece.begin(), piece.end()); });
}

void parallel_for_reporting(std::size_t count, std::size_t grain, Report& report,
                            const std::function<void(std::size_t, std::size_t, Report&)>& body) {
    std::vector<Report> found((count + grain - 1) / grain);
    parallel_for(found.size(), 1, [&](std::size_t first, std::size_t last) {
        for (std::size_t piece = first; piece < last; ++piece)
            body(piece * grain, std::min(count, (piece + 1) * grain), found[piece]);
    });
    for (const Report& one : found)
        report.merge(one);
}

std::size_t thread_count() {
    // The cap of set_thread_limit, or what the machine has. Asking starts no threads.
    const auto capped =
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    return std::min<std::size_t>(
        capped, static_cast<std::size_t>(std::max(tbb::info::default_concurrency(), 1)));
}

void parallel_tasks(const std::vector<std::function<void()>>& tasks, bool are_small) {
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

void set_thread_limit(unsigned count) {
    static std::unique_ptr<tbb::global_control> limit;
    limit.reset();
    if (count > 0) {
        limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                      count);
    }
}

}  // namespace relief
