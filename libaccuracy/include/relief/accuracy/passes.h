// SPDX-License-Identifier: Apache-2.0
/// \file
/// Experiments gone through several times, each time for a share of their rounds.
///
/// The methods of an experiment take turns, so that none is favoured; but all of its rounds may lie
/// within a second, and a busy second of the machine then looks like slower methods. Passes spread
/// the rounds of each method over the whole run: such a second is in one pass, and the median does
/// not see it. Memory is laid out anew in each, which is chance too.
/// Tests: tests/accuracy/passes_test.cpp.
#pragma once

#include <any>
#include <cstddef>
#include <functional>
#include <vector>

#include "relief/accuracy/experiment.h"

namespace relief {

/// The rounds that earlier passes took of each group of methods. A group is what is timed in
/// turns; groups are known by the order in which they are, the same in every pass.
class EarlierPasses {
  public:
    /// \param passes  at least 1
    explicit EarlierPasses(std::size_t passes) : passes_(passes) {}

    /// The next pass: groups count from the first again.
    void begin_pass();

    /// Of `rounds`, how many this pass takes; the first ones one more where they do not come out
    /// even.
    [[nodiscard]] std::size_t share_of(std::size_t rounds) const;

    /// What is known of the next group, to be added to. \param methods  how many are in it
    /// \throws std::runtime_error if there were more or fewer in the pass before
    std::vector<Timing>& next_group(std::size_t methods);

    /// What the first pass made in this place, in the order of places; made by `make` there.
    const std::any& next_result(const std::function<std::any()>& make);

  private:
    std::size_t passes_;
    std::size_t begun_ = 0;
    std::size_t next_group_ = 0;
    std::size_t next_result_ = 0;
    std::vector<std::vector<Timing>> groups_;
    std::vector<std::any> results_;
};

/// What `make` gives, made in the first pass alone: for truths and curves that take their time, and
/// are the same in every pass.
template <typename Make>
auto made_once(const RunOptions& options, const Make& make) {
    using Result = decltype(make());
    if (!options.earlier) return make();
    return std::any_cast<Result>(options.earlier->next_result([&] { return std::any(make()); }));
}

/// Runs experiments so many times; each sees the rounds of the passes before it, so that what the
/// last one gives has all of them, and its findings speak of all.
///
/// \param passes   at least 1; no more are made than there are rounds to take: without times, one
/// \param options  whose repeats are those of all passes together; each pass warms up
/// \param run      runs all experiments with these options; the same ones each time. What it throws
///                 passes
/// \return what the last pass gave
std::vector<Experiment> run_in_passes(
    std::size_t passes, const RunOptions& options,
    const std::function<std::vector<Experiment>(const RunOptions& options, std::size_t pass)>& run);

}  // namespace relief
