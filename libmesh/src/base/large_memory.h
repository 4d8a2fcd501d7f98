// SPDX-License-Identifier: Apache-2.0
/// \file
/// Memory for many megabytes at once. Tests: tests/mesh/base/large_memory_test.cpp.
#pragma once

#include <cstddef>
#include <vector>

namespace relief {

/// Tells the system that memory which nobody has touched yet will be filled from end to end.
///
/// Linux then gives it in pages of 2 MiB, where its settings allow that to those who ask (common
/// defaults), instead of 4 KiB at 1 to 2 microseconds each: as long as copying the bytes takes, or
/// longer. Small memory is left alone; contents never change.
void expect_filling(void* begin, std::size_t size);

/// Makes room in an empty vector that will be filled from end to end.
template <typename T>
void reserve_to_fill(std::vector<T>& values, std::size_t count) {
    values.reserve(count);
    expect_filling(values.data(), count * sizeof(T));
}

}  // namespace relief
