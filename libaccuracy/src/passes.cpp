// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/passes_test.cpp.
#include "relief/accuracy/passes.h"

#include <algorithm>
#include <memory>
#include <stdexcept>

namespace relief {

void EarlierPasses::begin_pass() {
    ++begun_;
    next_group_ = 0;
    next_result_ = 0;
}

std::size_t EarlierPasses::share_of(std::size_t rounds) const {
    const std::size_t passes_before = begun_ > 0 ? begun_ - 1 : 0;
    return rounds / passes_ + (passes_before < rounds % passes_ ? 1 : 0);
}

std::vector<Timing>& EarlierPasses::next_group(std::size_t methods) {
    if (next_group_ == groups_.size()) groups_.emplace_back(methods);
    std::vector<Timing>& group = groups_[next_group_++];
    if (group.size() != methods)  // OpenGL that was there and is gone, say.
        throw std::runtime_error("an experiment times other methods than in the pass before");
    return group;
}

const std::any& EarlierPasses::next_result(const std::function<std::any()>& make) {
    if (next_result_ == results_.size()) results_.push_back(make());
    return results_[next_result_++];
}

std::vector<Experiment> run_in_passes(
    std::size_t passes, const RunOptions& options,
    const std::function<std::vector<Experiment>(const RunOptions& options, std::size_t pass)>&
        run) {
    RunOptions with_rounds = options;
    // Without a round to take a pass would find nothing new.
    const std::size_t needed =
        options.is_timed ? std::clamp<std::size_t>(options.repeats.counted, 1, passes) : 1;
    with_rounds.earlier = std::make_shared<EarlierPasses>(needed);
    std::vector<Experiment> found;
    for (std::size_t pass = 0; pass < needed; ++pass) {
        with_rounds.earlier->begin_pass();
        found = run(with_rounds, pass);
    }
    return found;
}

}  // namespace relief
