// SPDX-License-Identifier: Apache-2.0
/// \file
/// Health markers looked for on a thread of their own: millions of triangles take seconds.
/// Tests: tests/tools/window/health_search_test.cpp.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "debug_choices.h"
#include "relief/shade/health_markers.h"
#include "window/newest_job.h"

namespace relief::tools {

/// What to look for.
struct HealthWish {
    std::shared_ptr<const Scene> scene;
    std::optional<HealthChoice> choice;  ///< Absent: nothing, and a search that goes on ends.
};

struct FoundHealth {
    HealthMarkers markers;
    std::string error;
};

class HealthSearch {
  public:
    /// \param wake  called, from another thread, when there is something to take
    explicit HealthSearch(std::function<void()> wake) : job_(std::move(wake)) {}

    void start(HealthWish wish);
    std::optional<FoundHealth> take() { return job_.take(); }
    [[nodiscard]] bool is_going_on() const { return job_.is_going_on(); }

  private:
    NewestJob<FoundHealth> job_;
};

}  // namespace relief::tools
