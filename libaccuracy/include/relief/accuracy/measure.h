// SPDX-License-Identifier: Apache-2.0
/// \file
/// Measures the time and memory of several functions, interleaved, and runs experiments in several
/// passes.
/// Tests: tests/accuracy/measure_test.cpp, tests/accuracy/experiment_driver_test.cpp.
#pragma once

#include <any>
#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "relief/accuracy/experiment.h"
#include "relief/export.h"

namespace RELIEF_API relief {

/// Measures several things interleaved (A B C A B C ...). All experiments use this function.
///
/// \param group  names these things within their experiment, so that passes find their rounds
/// \param options  its repeats, or the share of them that belongs to this pass (PassHistory)
/// \param seconds_of_round  runs one round of thing `thing` and returns its time
/// \return the times of each thing, including those of earlier passes. Cancellation is checked
///         before each round
std::vector<Timing> measure_interleaved_rounds(
    const std::string& group, std::size_t things, const RunOptions& options,
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

// Passes: the methods of an experiment are interleaved, so that none has an advantage. But all its
// rounds may lie within a second, and if the machine is busy in that second, the methods look
// slower. Passes spread the rounds of each method over the whole run, so that the median ignores
// such a second. Each pass also allocates its memory again, which averages effects of its layout.

/// The rounds and results of earlier passes, by experiment and name. A group is a set of methods
/// that are timed together.
class PassHistory {
  public:
    /// \param passes  at least 1
    explicit PassHistory(std::size_t passes) : passes_(passes) {}

    /// Starts the next pass, outside of all experiments.
    void begin_pass();

    /// Selects the experiment of the following calls. The empty id stands for calls outside of all
    /// experiments.
    void begin_experiment(const std::string& id);

    /// Returns the number of `rounds` in this pass; if they cannot be divided evenly, the first
    /// passes have one more.
    [[nodiscard]] std::size_t share_of(std::size_t rounds) const;

    /// Returns the rounds of a group, to which new ones are added. \param methods  number of
    /// methods in the group
    /// \throws std::runtime_error if the previous pass had another number of methods
    std::vector<Timing>& group(const std::string& name, std::size_t methods);

    /// Returns the result of this name; the first pass computes it with `make`.
    const std::any& result(const std::string& name, const std::function<std::any()>& make);

  private:
    struct Record {
        std::map<std::string, std::vector<Timing>> groups{};
        std::map<std::string, std::any> results{};
    };

    std::size_t passes_;
    std::size_t begun_ = 0;
    std::map<std::string, Record> records_;  ///< By id of the experiment.
    std::string id_;
};

/// Returns the result of `make`, which is called only in the first pass: for ground truths and
/// curves that are slow to compute and equal in every pass.
/// \param name  of the result, unique in its experiment
template <typename Make>
auto computed_once(const RunOptions& options, const std::string& name, const Make& make) {
    using Result = decltype(make());
    if (!options.earlier) return make();
    return std::any_cast<Result>(options.earlier->result(name, [&] { return std::any(make()); }));
}

/// Runs experiments several times. Each pass sees the rounds of the previous ones, so the results
/// of the last pass and their findings contain all of them.
///
/// \param passes  at least 1; at most the number of rounds; without timing there is one
/// \param options  its repeats are those of all passes together; each pass has its own warm-up
/// \param run  runs all experiments with these options, the same ones each time. Its exceptions are
///         passed on
/// \return the result of the last pass
std::vector<Experiment> run_in_passes(
    std::size_t passes, const RunOptions& options,
    const std::function<std::vector<Experiment>(const RunOptions& options, std::size_t pass)>& run);

}  // namespace relief
