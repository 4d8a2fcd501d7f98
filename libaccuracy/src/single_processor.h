// SPDX-License-Identifier: Apache-2.0
/// \file
/// One processor for all threads, to time drawing on one thread.
#pragma once

#include <sched.h>

namespace relief::accuracy::detail {

/// Keeps all threads of this process on one processor during its lifetime. A software OpenGL driver
/// starts its threads only once, so this is the only way to time it on one thread. The destructor
/// restores the affinity that the calling thread had.
class SingleProcessor {
  public:
    SingleProcessor();
    ~SingleProcessor();
    SingleProcessor(const SingleProcessor&) = delete;
    SingleProcessor& operator=(const SingleProcessor&) = delete;

    /// Returns whether the system allowed it; if not, nothing has changed.
    [[nodiscard]] bool is_active() const { return is_active_; }

  private:
    ::cpu_set_t before_;
    bool is_active_ = false;
};

}  // namespace relief::accuracy::detail
