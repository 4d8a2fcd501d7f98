// SPDX-License-Identifier: Apache-2.0
/// \file
/// Parallel loops whose result does not depend on the number of threads. Only parallel.cpp uses
/// oneTBB.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {
namespace detail {

/// Calls body(begin, end) for disjoint pieces that cover [0, count), on all threads.
///
/// \param grain  minimum size of all pieces but the last
///
/// The body may write only elements of its own piece, and read only what no piece writes. The
/// result is then the same for any number of threads. If the operation has a Progress
/// (relief/mesh/execution.h), pieces are smaller, and cancellation is checked between them.
///
/// If a body throws, the loop throws after its threads have finished, and skips pieces after the
/// failed one. The exception is that of the failed piece with the smallest index, and all pieces
/// before it have run. A body that visits its elements in order therefore fails with the error of
/// the first bad element, for any number of threads; only the moment of a cancellation depends on
/// timing. The loop returns normally only if all pieces have run: a failure or cancellation
/// elsewhere, for example in an enclosing loop, does not end it.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Like parallel_for(), with a report for each piece. The reports are merged into `report` in the
/// order of the pieces, which do not depend on the number of threads.
void parallel_for_reporting(
    std::size_t count, std::size_t grain, Report& report,
    const std::function<void(std::size_t begin, std::size_t end, Report& found)>& body);

/// Returns the maximum number of threads of parallel_for(), for callers that create one object per
/// thread.
std::size_t thread_count();

/// Runs independent tasks in parallel; one after another if `are_small`, because starting threads
/// would cost more.
///
/// If several throw, the caller gets the exception of the first one in the given order; the others
/// still run.
void parallel_tasks(const std::vector<std::function<void()>>& tasks, bool are_small);

/// For tests: parallel_for() calls this function before each piece, on the piece's thread, even if
/// the loop has only one piece. An exception counts as thrown by the piece. The default is null.
extern constinit std::atomic<void (*)()> before_each_piece;

}  // namespace detail
}  // namespace relief
