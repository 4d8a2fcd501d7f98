// SPDX-License-Identifier: Apache-2.0
/// \file
/// Memory of many megabytes: checks of the limits of this process (relief/mesh/limits.h) before it
/// is allocated, and large pages, which change only the time.
#pragma once

#if defined(__linux__)
#include <sys/mman.h>
#endif
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "relief/export.h"

namespace RELIEF_API relief {
namespace detail {

/// \throws InvalidInput if `count` elements of `size` bytes exceed the limit of memory
void require_memory(std::uint64_t count, std::uint64_t size);

/// \throws FileError if `count` elements of `size` bytes exceed the limit of memory
void require_memory_for(const std::filesystem::path& file, std::uint64_t count,
                        std::uint64_t size = 1);

/// \throws FileError if an image exceeds the limit of pixels
void require_pixels(const std::filesystem::path& file, int width, int height);

/// Tells the system that untouched memory will be filled completely.
///
/// Linux then provides it in pages of 2 MiB, if its settings allow this on request (the common
/// default). Pages of 4 KiB cost 1 to 2 microseconds each, which is as much as copying the bytes or
/// more. Small ranges are ignored; contents never change.
inline void expect_filling(void* begin, std::size_t size) {
    constexpr std::uintptr_t page = std::uintptr_t{2} << 20;
    const auto first = (reinterpret_cast<std::uintptr_t>(begin) + page - 1) / page * page;
    const auto end = (reinterpret_cast<std::uintptr_t>(begin) + size) / page * page;
    if (end <= first) return;
#if defined(__linux__)
    ::madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
#endif
}

/// Reserves memory in an empty vector that will be filled completely.
template <typename T>
void reserve_to_fill(std::vector<T>& values, std::size_t count) {
    values.reserve(count);
    expect_filling(values.data(), count * sizeof(T));
}

}  // namespace detail
}  // namespace relief
