// SPDX-License-Identifier: Apache-2.0
/// \file
/// Parallel loops whose result cannot depend on the number of threads. The only home of oneTBB.
#pragma once

#include <cstddef>
#include <functional>

namespace relief {

/// Calls body(begin, end) over disjoint pieces that cover [0, count), on all threads at once.
///
/// \param grain  pieces are no smaller than this, but for the last
///
/// The body may write only to elements of its own piece, and read only what no piece writes: then
/// the outcome is the same for any number of threads. An exception from a body reaches the caller.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

}  // namespace relief
