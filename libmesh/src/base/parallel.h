// SPDX-License-Identifier: Apache-2.0
/// \file
/// Parallel loops whose result cannot depend on the number of threads. The only home of oneTBB.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <vector>

#include "relief/mesh/report.h"

namespace relief {

/// Calls body(begin, end) over disjoint pieces that cover [0, count), on all threads at once.
///
/// \param grain  pieces are no smaller than this, but for the last
///
/// The body may write only to elements of its own piece, and read only what no piece writes: then
/// the outcome is the same for any number of threads. Where somebody waits for the work
/// (relief/mesh/progress.h), pieces are smaller and report to it too, and a wish to end it is heard
/// between them.
///
/// If a body throws, the loop throws after its threads have finished, and it leaves out pieces
/// behind the failed one. The exception is that of the failed piece with the smallest index, and
/// all pieces before it have run. So a body that visits its elements in order fails with the error
/// of the first bad element, for any number of threads; only the moment of a cancellation depends
/// on timing. The loop never returns normally unless every piece has run: a failure or a
/// cancellation elsewhere, for example in a loop around it, does not end it.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// The same, where each piece may find something: what all report comes together in `report`, in
/// the order of the pieces, which are the same for any number of threads.
void parallel_for_reporting(
    std::size_t count, std::size_t grain, Report& report,
    const std::function<void(std::size_t begin, std::size_t end, Report& found)>& body);

/// How many threads parallel_for() has at most: for those who must make as many of something.
std::size_t thread_count();

/// Runs tasks that do not touch what another writes: at once, or one by one where they are so small
/// that starting threads would take longer.
///
/// Of several that throw, the first in the order given reaches the caller; the others still run.
void parallel_tasks(const std::vector<std::function<void()>>& tasks, bool are_small);

/// For tests: parallel_for calls this function before each piece, on the piece's thread, also where
/// a loop is one piece. What it throws counts as thrown by the piece. Null, the default: none.
extern constinit std::atomic<void (*)()> before_each_piece;

}  // namespace relief
