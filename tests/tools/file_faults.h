// SPDX-License-Identifier: Apache-2.0
/// \file
/// Runs a program with a fault at one of its system calls that change files: the call fails, or a
/// signal arrives before it. The kernel asks this process about each of these calls (seccomp's user
/// notifications, Linux 5.5), so the program needs no change and no call is missed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace relief::test {

/// A fault before the call with a number, counted from 0.
struct Fault {
    std::size_t call = 0;
    int error = 0;   ///< The call is not made, and fails with this error number.
    int signal = 0;  ///< This signal is sent, and then the call is made.
    /// Whether all attempts to give a file a second name fail, as on file systems without hard
    /// links.
    bool has_no_links = false;
};

struct FaultResult {
    int exit_code = 0;      ///< 128 + the signal's number, if one ended the program.
    std::size_t calls = 0;  ///< The number of calls that change files.
    std::string call_name;  ///< The call with the fault; empty if the program ended before it.
};

/// Returns whether this kernel has user notifications.
bool can_inject_faults();

/// Runs words[0], a path, with the others as arguments; its output is discarded.
/// \param folder   the working directory
/// \param changed  the folder whose files count
FaultResult run_with_fault(const std::vector<std::string>& words,
                           const std::filesystem::path& folder,
                           const std::filesystem::path& changed, const Fault& fault);

}  // namespace relief::test
