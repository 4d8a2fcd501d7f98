// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/one_processor_test.cpp.
#include "drawn/one_processor.h"

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>

namespace relief {
namespace {

/// Where all threads of this process may run from now on; those that they start, too.
bool keep_all_on(const ::cpu_set_t& processors) {
    std::error_code failed;
    bool is_kept = true;
    // A thread may begin or end meanwhile: one that is gone is no failure.
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task", failed)) {
        const auto thread = static_cast<::pid_t>(std::stoi(entry.path().filename().string()));
        const bool is_set = ::sched_setaffinity(thread, sizeof processors, &processors) == 0;
        is_kept = is_kept && (is_set || errno == ESRCH);
    }
    return is_kept && !failed;
}

/// The first of them alone.
::cpu_set_t first_of(const ::cpu_set_t& processors) {
    ::cpu_set_t first;
    CPU_ZERO(&first);
    for (int one = 0; one < CPU_SETSIZE; ++one) {
        if (!CPU_ISSET(one, &processors)) continue;
        CPU_SET(one, &first);
        break;
    }
    return first;
}

}  // namespace

OneProcessor::OneProcessor() {
    CPU_ZERO(&before_);
    if (::sched_getaffinity(0, sizeof before_, &before_) != 0) return;
    is_kept_ = keep_all_on(first_of(before_));
    if (!is_kept_) keep_all_on(before_);
}

OneProcessor::~OneProcessor() {
    if (is_kept_) keep_all_on(before_);
}

}  // namespace relief
