// SPDX-License-Identifier: Apache-2.0
/// \file
/// The peak memory of this process, including libraries and all threads.
///
/// A test that measures it needs a process of its own, and links relief_memory_test_support.
/// Without that library, AddressSanitizer counts up to 256 MB of freed memory.
#pragma once

#include <sys/resource.h>

namespace relief::test {

inline double peak_megabytes() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) * 1024 / 1e6;
}

}  // namespace relief::test
