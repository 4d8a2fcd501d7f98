// SPDX-License-Identifier: Apache-2.0
/// \file
/// Time and memory of several ways to do a thing, measured in turns. None of it depends on
/// what is measured; clocks and turns are those of timing.h. Tests:
/// tests/accuracy/measure_test.cpp.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "relief/accuracy/experiment.h"

namespace relief {

/// Times things in turns, A B C A B C: the one way in which experiments do.
///
/// \param options           its repeats, or the share of them that this pass takes (passes.h)
/// \param seconds_of_round  takes a round of thing `thing`
/// \return by thing, the rounds of earlier passes first. A wish to end is heard before each round
std::vector<Timing> rounds_in_turns(
    std::size_t things, const RunOptions& options,
    const std::function<double(std::size_t thing)>& seconds_of_round);

/// The same with relief's parallel loops on one thread; on options.threads afterwards.
std::vector<Timing> on_one_thread(const RunOptions& options,
                                  const std::function<std::vector<Timing>()>& measured);

/// What measure_costs() looks at.
struct CostChoice {
    bool one_thread = true;
    bool all_threads = true;
    bool memory = true;
};

/// Runs each work in turn, A B C A B C, on one thread, then on all, and once more for its memory.
///
/// \param works    each does its whole job once and lets its result go; results must not depend on
///                 how often it was run
/// \param options  its repeats are those that count; a work of less than 4 milliseconds is repeated
///                 within a round until it takes that, and the time is divided
/// \return in the order of the works; nothing measured where options.is_timed is false. Times on
///         one thread are those of the processor, so that other programs do not add to them; times
///         on all threads are those of the wall clock
///
/// The thread limit is options.threads afterwards. Memory is what the process held
/// resident at the most, as Linux counts it, beyond what it held before: pages, not bytes.
std::vector<Cost> measure_costs(std::span<const std::function<void()>> works,
                                const RunOptions& options, const CostChoice& choice = {});

/// The most memory that `work` held at a time beyond what there was before, in bytes; nothing where
/// the system does not tell.
std::optional<std::uint64_t> peak_bytes_of(const std::function<void()>& work);

}  // namespace relief
