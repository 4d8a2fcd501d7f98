// SPDX-License-Identifier: Apache-2.0
// dlopen and dlsym, with words for what is missing. See dynamic_library.h.
// Tests: tests/shade/gl/context_test.cpp.
#include "gl/dynamic_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>

#include "relief/shade/error.h"

namespace relief::gl {

namespace {

std::string loader_message() {
    const char* message = dlerror();
    return message == nullptr ? "unknown reason" : message;
}

}  // namespace

DynamicLibrary::DynamicLibrary(const char* variable, std::span<const char* const> names) {
    const char* chosen = std::getenv(variable);
    const bool is_chosen = chosen != nullptr && *chosen != '\0';
    if (is_chosen) names = std::span(&chosen, 1);
    std::string reasons;
    for (const char* name : names) {
        // RTLD_LOCAL: OSMesa brings a second set of gl... symbols that must not replace others.
        library_ = dlopen(name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
        if (library_ != nullptr) {
            name_ = name;
            return;
        }
        reasons += (reasons.empty() ? "" : "; ") + loader_message();
    }
    throw GpuError(is_chosen ? fmt::format("{} ({} is set)", reasons, variable) : reasons);
}

void* DynamicLibrary::symbol(const char* name) const {
    void* found = dlsym(library_, name);
    if (found == nullptr) throw GpuError(fmt::format("{} has no function {}", name_, name));
    return found;
}

}  // namespace relief::gl
