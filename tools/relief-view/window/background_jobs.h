// SPDX-License-Identifier: Apache-2.0
/// \file
/// Background jobs of the window: reading scenes and searching for mesh problems.
/// Tests: tests/tools/window/background_jobs_test.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "relief/mesh/execution.h"
#include "relief/mesh/timing.h"
#include "relief/shade/frame_settings.h"
#include "scene_options.h"
#include "view_options.h"

namespace relief::tools {

/// Runs work on another thread. Only the work that was started last has a result; starting new work
/// cancels the previous work without waiting for it.
template <typename Result>
class NewestJob {
  public:
    /// Runs inside a ProgressScope of its argument. It may throw only Cancelled; other errors are
    /// part of the result.
    using Work = std::function<Result(const Progress& progress)>;

    /// \param wake  called from another thread when there is a result
    explicit NewestJob(std::function<void()> wake) : wake_(std::move(wake)) {}

    /// Cancels the work and waits for its end.
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
        discard();
        since_begun_ = {};
        newest_ = &jobs_.emplace_back();
        newest_->thread =
            std::thread([this, job = newest_, task = std::move(work)] { run(*job, task); });
    }

    void cancel() {
        const std::lock_guard lock(mutex_);
        discard();
    }

    /// The result of the last start(), if it is ready. Each result is returned once.
    std::optional<Result> take() {
        const std::lock_guard lock(mutex_);
        if (result_) newest_ = nullptr;
        return std::exchange(result_, std::nullopt);
    }

    /// True from start() until take() returns the result, or cancel().
    [[nodiscard]] bool is_running() const {
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

    void discard() {
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
    std::list<Job> jobs_;    ///< Running, or not joined yet.
    Job* newest_ = nullptr;  ///< Null if no result is wanted.
    Stopwatch since_begun_;
    std::optional<Result> result_;
};

/// The result of reading a file: a scene or an error.
struct Loaded {
    ViewOptions options;
    std::optional<ComposedScene> composed;
    Report findings;
    std::string error;
    std::map<std::filesystem::path, FileStamp> files;  ///< Files that were read or not found.
    double seconds = 0.0;
};

/// Reads and composes scenes.
class Loader {
  public:
    /// \param wake  called from another thread when there is a result
    explicit Loader(std::function<void()> wake) : job_(std::move(wake)) {}

    /// Reads the model of these options. An earlier call is cancelled.
    void start(const ViewOptions& options);

    /// Cancels reading.
    void cancel() { job_.cancel(); }

    /// The result of the last start(), if it is ready. Each result is returned once.
    std::optional<Loaded> take() { return job_.take(); }

    /// True from start() until take() returns the result, or cancel().
    [[nodiscard]] bool is_loading() const { return job_.is_running(); }
    [[nodiscard]] double seconds_so_far() const { return job_.seconds_so_far(); }
    [[nodiscard]] Progress::State progress() const { return job_.progress(); }

  private:
    NewestJob<Loaded> job_;
};

/// A scene to check.
struct HealthRequest {
    std::shared_ptr<const Scene> scene;
    std::optional<HealthChoice> choice;  ///< If absent, the search is cancelled.
};

/// The marked problems, or an error.
struct HealthResult {
    HealthMarkers markers;
    std::string error;
};

/// Searches for mesh problems, which takes seconds for millions of triangles.
class HealthSearch {
  public:
    /// \param wake  called from another thread when there is a result
    explicit HealthSearch(std::function<void()> wake) : job_(std::move(wake)) {}

    void start(HealthRequest request);
    std::optional<HealthResult> take() { return job_.take(); }
    [[nodiscard]] bool is_running() const { return job_.is_running(); }

  private:
    NewestJob<HealthResult> job_;
};

}  // namespace relief::tools
