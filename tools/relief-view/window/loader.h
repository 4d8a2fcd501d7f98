// SPDX-License-Identifier: Apache-2.0
/// \file
/// Scenes read and composed on a thread of their own, so that the window answers meanwhile.
/// Tests: tests/tools/window/loader_test.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "scene_options.h"
#include "window/newest_job.h"

namespace relief::tools {

/// What came of a file: a scene, or an error.
struct Loaded {
    ViewOptions options;
    std::optional<ComposedScene> composed;
    Report findings;
    std::string error;
    std::map<std::filesystem::path, FileStamp> files;  ///< That were read, or not found.
    double seconds = 0.0;
};

class Loader {
  public:
    /// \param wake  called, from another thread, when there is something to take
    explicit Loader(std::function<void()> wake) : job_(std::move(wake)) {}

    /// Begins to read what the options name; what was begun before ends.
    void start(const ViewOptions& options);

    /// The same without another beginning.
    void cancel() { job_.cancel(); }

    /// What was begun last, once it is there; only once.
    std::optional<Loaded> take() { return job_.take(); }

    /// From start() until the result is taken, or cancel().
    [[nodiscard]] bool is_loading() const { return job_.is_going_on(); }
    [[nodiscard]] double seconds_so_far() const { return job_.seconds_so_far(); }
    [[nodiscard]] Progress::State progress() const { return job_.progress(); }

  private:
    NewestJob<Loaded> job_;  ///< Ends with this.
};

}  // namespace relief::tools
