// SPDX-License-Identifier: Apache-2.0
/// \file
/// Work on a thread of its own, of which only what was begun last counts: a beginning ends what was
/// begun before it, and nobody waits for that but the end of the object.
/// Tests: tests/tools/window/newest_job_test.cpp.
#pragma once

#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "relief/mesh/progress.h"
#include "relief/mesh/timing.h"

namespace relief::tools {

template <typename Result>
class NewestJob {
  public:
    /// Runs in a ProgressScope of its argument. Throws nothing but Cancelled: what can fail is a
    /// result.
    using Work = std::function<Result(const Progress& progress)>;

    /// \param wake  called, from another thread, when there is something to take
    explicit NewestJob(std::function<void()> wake) : wake_(std::move(wake)) {}

    /// Ends what is going on, and waits until it has.
    ~NewestJob() {
        for (Job& job : jobs_)
            job.progress.cancel();
        for (Job& job : jobs_)
            job.thread.join();
    }
    NewestJob(const NewestJob&) = delete;
    NewestJob& operator=(const NewestJob&) = delete;

    void start(Work work) {
        join_ended();
        const std::lock_guard lock(mutex_);
        forget();
        since_begun_ = {};
        newest_ = &jobs_.emplace_back();
        newest_->thread =
            std::thread([this, job = newest_, task = std::move(work)] { run(*job, task); });
    }

    void cancel() {
        const std::lock_guard lock(mutex_);
        forget();
    }

    /// What was begun last, once it is there; only once.
    std::optional<Result> take() {
        const std::lock_guard lock(mutex_);
        if (result_) newest_ = nullptr;
        return std::exchange(result_, std::nullopt);
    }

    /// From start() until the result is taken, or cancel().
    [[nodiscard]] bool is_going_on() const {
        const std::lock_guard lock(mutex_);
        return newest_ != nullptr;
    }
    [[nodiscard]] double seconds_so_far() const {
        const std::lock_guard lock(mutex_);
        return newest_ ? since_begun_.seconds() : 0.0;
    }
    [[nodiscard]] Progress::State progress() const {
        const std::lock_guard lock(mutex_);
        return newest_ ? newest_->progress.state() : Progress::State{};
    }

  private:
    struct Job {
        Progress progress;
        std::thread thread;
        bool has_ended = false;
    };

    void forget() {
        if (newest_) newest_->progress.cancel();
        newest_ = nullptr;
        result_.reset();
    }

    void run(Job& job, const Work& work) {
        std::optional<Result> result;
        try {
            const ProgressScope scope(job.progress);
            result.emplace(work(job.progress));
        } catch (const Cancelled&) {
            result.reset();
        }
        {
            const std::lock_guard lock(mutex_);
            job.has_ended = true;
            if (newest_ != &job || job.progress.is_cancelled()) return;
            result_ = std::move(result);
        }
        wake_();
    }

    void join_ended() {
        std::list<Job> ended;
        {
            const std::lock_guard lock(mutex_);
            for (auto job = jobs_.begin(); job != jobs_.end();) {
                const auto next = std::next(job);
                if (job->has_ended && &*job != newest_) ended.splice(ended.end(), jobs_, job);
                job = next;
            }
        }
        for (Job& job : ended)
            job.thread.join();
    }

    std::function<void()> wake_;
    mutable std::mutex mutex_;
    std::list<Job> jobs_;    ///< Going on, or not joined yet.
    Job* newest_ = nullptr;  ///< Nothing, where nothing is wanted.
    Stopwatch since_begun_;
    std::optional<Result> result_;
};

}  // namespace relief::tools
