// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/accuracy_run_test.cpp.
#include "processor_use.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>

namespace relief::tools {
namespace {

double seconds_now() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double>(now).count();
}

/// Returns the processor time of this process and of its children that have ended.
double own_seconds() {
    double seconds = 0.0;
    for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage use{};
        getrusage(who, &use);
        for (const timeval& time : {use.ru_utime, use.ru_stime})
            seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    }
    return seconds;
}

/// Returns the time that all processors were busy since the start of the system.
std::optional<double> all_seconds() {
    std::ifstream stream("/proc/stat");
    std::string name;
    // Guests count as "user" already.
    double user = 0, nice = 0, system = 0, idle = 0, waiting = 0, irq = 0, softirq = 0, steal = 0;
    stream >> name >> user >> nice >> system >> idle >> waiting >> irq >> softirq >> steal;
    const long ticks = sysconf(_SC_CLK_TCK);
    if (!stream || name != "cpu" || ticks <= 0) return std::nullopt;
    return (user + nice + system + irq + softirq + steal) / static_cast<double>(ticks);
}

}  // namespace

std::string to_string(const OtherPrograms& others) {
    return fmt::format(
        "used {:.2g} of {} processors{}", others.processors, others.available,
        others.is_busy() ? ": the machine was busy, and wall-clock times are too long" : "");
}

ProcessorUse::ProcessorUse()
    : wall_seconds_(seconds_now()), own_seconds_(own_seconds()), all_seconds_(all_seconds()) {}

std::optional<OtherPrograms> ProcessorUse::of_others() const {
    const std::optional<double> all = all_seconds();
    const double wall = seconds_now() - wall_seconds_;
    const long processors = sysconf(_SC_NPROCESSORS_ONLN);
    if (!all || !all_seconds_ || !(wall > 0.0) || processors <= 0) return std::nullopt;
    const double others = *all - *all_seconds_ - (own_seconds() - own_seconds_);
    const auto available = static_cast<unsigned>(processors);
    return OtherPrograms{std::clamp(others / wall, 0.0, static_cast<double>(available)), available};
}

}  // namespace relief::tools
