// SPDX-License-Identifier: Apache-2.0
// Describes the machine by /proc, uname and the compiler.
// Tests: tests/tools/accuracy_report_test.cpp.
#include "accuracy_report.h"

#include <fmt/format.h>
#include <sched.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <thread>
#include <vector>

#include "common/text.h"
#include "relief/shade/context.h"

namespace relief::tools {
namespace {

/// Returns the text after `separator` in the first line of a file that begins with `key`.
std::string value_in(const char* file, const std::string& key, char separator) {
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
        const std::size_t end = line.find(separator);
        if (!line.starts_with(key) || end == std::string::npos) continue;
        const std::size_t begin = line.find_first_not_of(" \"", end + 1);
        if (begin == std::string::npos) return "";
        return line.substr(begin, line.find_last_not_of(" \"") - begin + 1);
    }
    return "";
}

unsigned usable_cores() {
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) == 0) return static_cast<unsigned>(CPU_COUNT(&set));
    return std::thread::hardware_concurrency();
}

std::uint64_t installed_memory() {
    const long pages = sysconf(_SC_PHYS_PAGES);
    const long size = sysconf(_SC_PAGE_SIZE);
    if (pages <= 0 || size <= 0) return 0;
    return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(size);
}

std::string system_name() {
    utsname kernel{};
    uname(&kernel);
    const std::string kernel_name =
        fmt::format("{} {} {}", kernel.sysname, kernel.release, kernel.machine);
    const std::string distribution = value_in("/etc/os-release", "PRETTY_NAME", '=');
    return distribution.empty() ? kernel_name : fmt::format("{}, {}", distribution, kernel_name);
}

std::string compiler_name() {
#if defined(__clang__)
    return "Clang " __clang_version__;
#else
    return "GCC " __VERSION__;
#endif
}

std::optional<std::string> opengl_name() {
    try {
        return Context().renderer_name();
    } catch (const GpuError&) {
        return std::nullopt;
    }
}

/// The memory that the kernel reserves differs slightly between starts.
bool have_same_memory(const Machine& a, const Machine& b) {
    const auto least = static_cast<double>(std::min(a.memory_bytes, b.memory_bytes));
    const auto most = static_cast<double>(std::max(a.memory_bytes, b.memory_bytes));
    return most <= 1.02 * least;
}

}  // namespace

Machine this_machine(bool draws) {
    return {.processor = value_in("/proc/cpuinfo", "model name", ':'),
            .cores = usable_cores(),
            .memory_bytes = installed_memory(),
            .system = system_name(),
            .compiler = compiler_name(),
            .build = RELIEF_BUILD_TYPE,
            .opengl = draws ? opengl_name() : std::nullopt};
}

std::string difference_of(const Machine& old_one, const Machine& new_one) {
    std::vector<std::string> words;
    const auto compare = [&](const char* what, const std::string& before,
                             const std::string& after) {
        if (before != after) words.push_back(fmt::format("{}: {}, then {}", what, before, after));
    };
    compare("processor", old_one.processor, new_one.processor);
    compare("cores", fmt::to_string(old_one.cores), fmt::to_string(new_one.cores));
    if (!have_same_memory(old_one, new_one))
        compare("memory", byte_size(old_one.memory_bytes), byte_size(new_one.memory_bytes));
    compare("system", old_one.system, new_one.system);
    compare("compiler", old_one.compiler, new_one.compiler);
    compare("build", old_one.build, new_one.build);
    if (old_one.opengl && new_one.opengl) compare("OpenGL", *old_one.opengl, *new_one.opengl);
    return fmt::format("{}", fmt::join(words, "; "));
}

bool may_compare_times(const Machine& old_one, const Machine& new_one) {
    const bool same_opengl =
        !old_one.opengl || !new_one.opengl || *old_one.opengl == *new_one.opengl;
    return old_one.processor == new_one.processor && old_one.cores == new_one.cores &&
           have_same_memory(old_one, new_one) && old_one.system == new_one.system && same_opengl;
}

}  // namespace relief::tools
