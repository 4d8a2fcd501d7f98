// SPDX-License-Identifier: Apache-2.0
// One libFuzzer program with all targets; the environment variable RELIEF_FUZZ_TARGET names one, or
// is "list". scripts/dev/fuzz builds and runs it.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "targets.h"

namespace relief {
namespace {

const FuzzTarget& chosen_target() {
    const char* const name = std::getenv("RELIEF_FUZZ_TARGET");
    for (const FuzzTarget& target : fuzz_targets()) {
        if (name != nullptr && target.name == name) return target;
    }
    std::string names;
    for (const FuzzTarget& target : fuzz_targets())
        names += fmt::format(" {}", target.name);
    if (name != nullptr && std::string_view(name) == "list") {
        fmt::print("{}\n", names);
        std::exit(0);
    }
    fmt::print(stderr, "RELIEF_FUZZ_TARGET is not list or one of{}\n", names);
    std::exit(2);
}

}  // namespace
}  // namespace relief

// libFuzzer calls the following functions. It takes a call of exit() for a fault, but not in the
// first one.
extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
    (void)relief::chosen_target();
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const relief::FuzzTarget& target = relief::chosen_target();
    relief::run_target(target, {data, size});
    return 0;
}
