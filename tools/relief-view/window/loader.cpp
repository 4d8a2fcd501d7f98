// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/loader_test.cpp.
#include "window/loader.h"

#include <algorithm>
#include <utility>

namespace relief::tools {
namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

Loader::~Loader() {
    for (Job& job : jobs_)
        job.thread.join();
}

void Loader::start(const ViewOptions& options) {
    join_ended();
    const std::lock_guard lock(mutex_);
    begun_ = std::chrono::steady_clock::now();
    is_wanted_ = true;
    result_.reset();
    const unsigned number = ++newest_;
    jobs_.push_back({number, std::thread([this, options, number] { load(options, number); })});
}

void Loader::cancel() {
    const std::lock_guard lock(mutex_);
    ++newest_;
    is_wanted_ = false;
    result_.reset();
}

void Loader::load(ViewOptions options, unsigned number) {
    const auto begin = std::chrono::steady_clock::now();
    Loaded loaded;
    try {
        Stages silent(true);
        loaded.composed = compose_scene(options, silent, loaded.findings);
    } catch (const std::exception& error) {
        loaded.error = error.what();
    }
    loaded.options = std::move(options);
    loaded.seconds = seconds_since(begin);
    {
        const std::lock_guard lock(mutex_);
        ended_.push_back(number);
        if (number != newest_) return;
        result_ = std::move(loaded);
    }
    wake_();
}

std::optional<Loaded> Loader::take() {
    const std::lock_guard lock(mutex_);
    if (!result_) return std::nullopt;
    is_wanted_ = false;
    return std::exchange(result_, std::nullopt);
}

bool Loader::is_loading() const {
    const std::lock_guard lock(mutex_);
    return is_wanted_;
}

double Loader::seconds_so_far() const {
    const std::lock_guard lock(mutex_);
    return is_wanted_ ? seconds_since(begun_) : 0.0;
}

/// Threads that have come to their end are let go.
void Loader::join_ended() {
    std::vector<Job> ended;
    {
        const std::lock_guard lock(mutex_);
        const auto is_ended = [&](const Job& job) {
            return std::find(ended_.begin(), ended_.end(), job.number) != ended_.end();
        };
        const auto first = std::stable_partition(jobs_.begin(), jobs_.end(),
                                                 [&](const Job& job) { return !is_ended(job); });
        std::move(first, jobs_.end(), std::back_inserter(ended));
        jobs_.erase(first, jobs_.end());
        ended_.clear();
    }
    for (Job& job : ended)
        job.thread.join();
}

}  // namespace relief::tools
