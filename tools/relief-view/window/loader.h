// SPDX-License-Identifier: Apache-2.0
/// \file
/// Scenes read and composed on a thread of their own, so that the window answers meanwhile.
/// Tests: tests/tools/window/loader_test.cpp.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "scene_options.h"

namespace relief::tools {

/// What came of a file: a scene, or an error.
struct Loaded {
    ViewOptions options;
    std::optional<ComposedScene> composed;
    Report findings;
    std::string error;
    double seconds = 0.0;
};

class Loader {
  public:
    /// \param wake  called, from another thread, when there is something to take
    explicit Loader(std::function<void()> wake) : wake_(std::move(wake)) {}

    /// Waits for what is being read.
    ~Loader();
    Loader(const Loader&) = delete;
    Loader& operator=(const Loader&) = delete;

    /// Begins to read what the options name; what was begun before is of no interest any more.
    void start(const ViewOptions& options);

    /// The same without another beginning.
    void cancel();

    /// What was begun last, once it is there; only once.
    std::optional<Loaded> take();

    /// From start() until the result is taken, or cancel().
    [[nodiscard]] bool is_loading() const;
    [[nodiscard]] double seconds_so_far() const;

  private:
    void load(ViewOptions options, unsigned number);
    void join_ended();

    struct Job {
        unsigned number;
        std::thread thread;
    };

    std::function<void()> wake_;
    mutable std::mutex mutex_;
    std::vector<Job> jobs_;
    std::vector<unsigned> ended_;
    unsigned newest_ = 0;  ///< Beginnings are counted.
    bool is_wanted_ = false;
    std::chrono::steady_clock::time_point begun_;
    std::optional<Loaded> result_;
};

}  // namespace relief::tools
