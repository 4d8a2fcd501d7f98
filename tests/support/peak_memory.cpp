// SPDX-License-Identifier: Apache-2.0
#include "support/peak_memory.h"

#include <sys/resource.h>

namespace relief::test {

double peak_megabytes() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) * 1024 / 1e6;
}

}  // namespace relief::test
