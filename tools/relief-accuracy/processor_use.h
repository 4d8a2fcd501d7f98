// SPDX-License-Identifier: Apache-2.0
/// \file
/// The load that other programs put on the machine during a run, on which wall-clock times depend.
/// Tests: tests/tools/accuracy_run_test.cpp.
#pragma once

#include <optional>
#include <string>

namespace relief::tools {

/// The processors that other programs used during a run.
struct OtherPrograms {
    double processors = 0.0;  ///< The mean over the run.
    unsigned available = 0;   ///< All processors of the machine.

    /// Returns whether they lengthened wall-clock times noticeably.
    [[nodiscard]] bool is_busy() const { return processors > 0.05 * available; }

    friend bool operator==(const OtherPrograms&, const OtherPrograms&) = default;
};

/// "used 1.7 of 2 processors: the machine was busy, and wall-clock times are too long"
std::string to_string(const OtherPrograms& others);

/// Measures processor times from its construction. On Linux it reads /proc/stat.
class ProcessorUse {
  public:
    ProcessorUse();
    /// Returns the use by others since construction; nullopt if the system does not state it.
    [[nodiscard]] std::optional<OtherPrograms> of_others() const;

  private:
    double wall_seconds_ = 0.0;
    double own_seconds_ = 0.0;
    std::optional<double> all_seconds_;
};

}  // namespace relief::tools
