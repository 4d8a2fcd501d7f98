// SPDX-License-Identifier: Apache-2.0
/// \file
/// Keeps a whole process on one processor for a while. A driver that draws in software starts its
/// threads once and for all; on one processor they take what one thread would. Tests:
/// tests/accuracy/one_processor_test.cpp.
#pragma once

#include <sched.h>

namespace relief {

/// While it lives, all threads of this process run on the first processor that it may use.
/// Afterwards all may run wherever the calling thread could before.
class OneProcessor {
  public:
    OneProcessor();
    ~OneProcessor();
    OneProcessor(const OneProcessor&) = delete;
    OneProcessor& operator=(const OneProcessor&) = delete;

    /// Whether the system let it; if not, nothing has changed.
    [[nodiscard]] bool is_kept() const { return is_kept_; }

  private:
    ::cpu_set_t before_;
    bool is_kept_ = false;
};

}  // namespace relief
