// SPDX-License-Identifier: Apache-2.0
// Advice to the system about large memory, see large_memory.h. Whether it is followed changes
// nothing but time. Tests: tests/mesh/base/large_memory_test.cpp.
#include "large_memory.h"

#include <sys/mman.h>

#include <cstdint>

namespace relief {

void expect_filling(void* begin, std::size_t size) {
    constexpr std::uintptr_t page = std::uintptr_t{2} << 20;
    const auto first = (reinterpret_cast<std::uintptr_t>(begin) + page - 1) / page * page;
    const auto end = (reinterpret_cast<std::uintptr_t>(begin) + size) / page * page;
    if (end <= first) return;
    ::madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
}

}  // namespace relief
