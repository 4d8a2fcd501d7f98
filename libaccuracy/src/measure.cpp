// SPDX-License-Identifier: Apache-2.0
// Measures processor time and resident memory, and limits threads and processors.
#include "measure.h"

#include <malloc.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include "relief/mesh/statistics.h"

namespace relief {

std::size_t repeats_per_round(const std::function<void()>& work) {
    constexpr double min_round_seconds = 4e-3;
    const double seconds = seconds_of(work);
    return seconds >= min_round_seconds
               ? 1
               : static_cast<std::size_t>(std::ceil(min_round_seconds / std::max(seconds, 1e-7)));
}

namespace {

/// Processor time of this process with all its threads, in seconds.
double processor_seconds() {
    timespec now{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The value of a line such as "VmHWM:   12345 kB" in /proc/self/status, in bytes.
std::optional<std::uint64_t> status_bytes(const std::string& name) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        std::uint64_t kilobytes = 0;
        if (word == name + ":" && status >> kilobytes) return kilobytes * 1024;
    }
    return std::nullopt;
}

}  // namespace

double processor_seconds_of(const std::function<void()>& work) {
    constexpr double min_seconds = 1e-9;  // Work that only waits must have a positive time.
    const double begin = processor_seconds();
    work();
    return std::max(processor_seconds() - begin, min_seconds);
}

std::optional<std::uint64_t> peak_bytes_of(const std::function<void()>& work) {
    ::malloc_trim(0);  // Otherwise the work could reuse memory that is already resident.
    std::ofstream reset("/proc/self/clear_refs");
    reset << 5 << std::flush;  // Sets VmHWM to the current VmRSS.
    const std::optional<std::uint64_t> before = status_bytes("VmRSS");
    if (!reset || !before) return std::nullopt;
    work();
    const std::optional<std::uint64_t> peak = status_bytes("VmHWM");
    if (!peak) return std::nullopt;
    return *peak - std::min(*peak, *before);
}

namespace {

/// Sets the affinity of all threads of this process. New threads inherit it.
bool set_affinity(const ::cpu_set_t& processors) {
    std::error_code failed;
    bool is_active = true;
    // A thread may end meanwhile; ESRCH is therefore not an error.
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task", failed)) {
        const auto thread = static_cast<::pid_t>(std::stoi(entry.path().filename().string()));
        const bool is_set = ::sched_setaffinity(thread, sizeof processors, &processors) == 0;
        is_active = is_active && (is_set || errno == ESRCH);
    }
    return is_active && !failed;
}

/// The set that holds only the first of `processors`.
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

SingleProcessor::SingleProcessor() {
    CPU_ZERO(&before_);
    if (::sched_getaffinity(0, sizeof before_, &before_) != 0) return;
    is_active_ = set_affinity(first_of(before_));
    if (!is_active_) set_affinity(before_);
}

SingleProcessor::~SingleProcessor() {
    if (is_active_) set_affinity(before_);
}

}  // namespace relief
