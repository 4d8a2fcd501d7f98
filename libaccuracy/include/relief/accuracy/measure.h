// SPDX-License-Identifier: Apache-2.0
/// \file
/// Measures the time and memory of several functions, interleaved.
/// Tests: tests/accuracy/measure_test.cpp.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "relief/accuracy/experiment.h"
#include "relief/export.h"

namespace RELIEF_API relief {

/// Measures several things interleaved (A B C A B C ...). All experiments use this function.
///
/// \param options  its repeats, or the share of them that belongs to this pass (passes.h)
/// \param seconds_of_round  runs one round of thing `thing` and returns its time
/// \return the times of each thing, including those of earlier passes. Cancellation is checked
///         before each round
std::vector<Timing> measure_interleaved_rounds(
    std::size_t things, const RunOptions& options,
    const std::function<double(std::size_t thing)>& seconds_of_round);

/// Runs `measured` with parallel loops limited to one thread, and then restores options.threads.
std::vector<Timing> on_one_thread(const RunOptions& options,
                                  const std::function<std::vector<Timing>()>& measured);

/// The costs that measure_costs() measures.
struct CostChoice {
    bool one_thread = true;
    bool all_threads = true;
    bool memory = true;
};

/// Runs all works interleaved (A B C A B C ...), on one thread, then on all, and once more for
/// memory.
///
/// \param works  each does its whole job once and frees its result; results must not depend on the
///         number of runs
/// \param options  its repeats are counted; a work shorter than 4 milliseconds is repeated within a
///         round until it takes that long, and the time is divided
/// \return the costs in the order of the works; nothing is measured if options.is_timed is false.
///         Times on one thread are CPU times, so that other programs do not add to them; times on
///         all threads are wall-clock times
///
/// Afterwards the thread limit is options.threads. Memory is the peak resident memory of the
/// process according to Linux minus the resident memory before, in whole pages.
std::vector<Cost> measure_costs(std::span<const std::function<void()>> works,
                                const RunOptions& options, const CostChoice& choice = {});

/// Returns the peak memory of `work` in bytes in addition to the memory before; nothing if the
/// system does not report it.
std::optional<std::uint64_t> peak_bytes_of(const std::function<void()>& work);

}  // namespace relief
