// SPDX-License-Identifier: Apache-2.0
// Memory of the tools. New memory costs the kernel's time: it clears each page, and maps pages of
// 4 KiB one by one, which takes longer than filling them.
//
// Large blocks are mapped, and get large pages on request, also those that vectors allocate.
// Smaller ones come from the heap, which keeps what is freed for the next pieces of work. A library
// must not replace these functions and settings, because they apply to the whole program.
#if defined(__linux__)
#include <malloc.h>
#endif

#include <cstdlib>
#include <new>

#include "large_memory.h"

namespace {

constexpr std::size_t large = std::size_t{4} << 20;

#if defined(M_MMAP_THRESHOLD) && defined(M_TRIM_THRESHOLD)
constexpr int kept_by_heap = 64 << 20;
[[maybe_unused]] const bool is_heap_set =
    ::mallopt(M_MMAP_THRESHOLD, large) == 1 && ::mallopt(M_TRIM_THRESHOLD, kept_by_heap) == 1;
#endif

}  // namespace

void* operator new(std::size_t size) {
    void* memory = std::malloc(size == 0 ? 1 : size);
    while (memory == nullptr) {
        const std::new_handler handler = std::get_new_handler();
        if (handler == nullptr) throw std::bad_alloc();
        handler();
        memory = std::malloc(size == 0 ? 1 : size);
    }
    if (size >= large) relief::detail::expect_filling(memory, size);
    return memory;
}

void operator delete(void* memory) noexcept {
    std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
