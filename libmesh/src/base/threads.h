// SPDX-License-Identifier: Apache-2.0
/// \file
/// The threads of parallel loops: oneTBB's, or those of a ThreadPool in builds without oneTBB.
#pragma once

#include <cstddef>
#include <functional>

namespace relief::detail {

/// Calls run_piece(begin, end) for disjoint pieces that cover [0, count), on all threads, and
/// returns when all have returned. Loops may be nested.
///
/// \param count      at least 1
/// \param grain      minimum size of all pieces but the last
/// \param run_piece  must not throw
void run_on_threads(std::size_t count, std::size_t grain,
                    const std::function<void(std::size_t begin, std::size_t end)>& run_piece);

/// Returns the limit of set_thread_limit(), but at most the number of processors. Starts no thread.
std::size_t thread_limit();

}  // namespace relief::detail
