// SPDX-License-Identifier: Apache-2.0
/// \file
/// Arrays for intermediate results, in memory of the operation's Workspace if it has one. Loops
/// that allocate in their pieces pass the Workspace on to their threads (parallel.cpp).
#pragma once

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "relief/export.h"
#include "relief/mesh/execution.h"

namespace RELIEF_API relief {
namespace detail {

/// The Workspace of this thread's operation; null if there is none.
extern constinit thread_local Workspace* current_workspace;

/// Memory with undefined content, for the duration of an operation. It begins at a multiple of 64
/// bytes, the size of a line of the cache and of the largest vector register.
class WorkMemory {
  public:
    WorkMemory() = default;
    explicit WorkMemory(std::size_t size);
    ~WorkMemory();
    WorkMemory(WorkMemory&& other) noexcept { *this = std::move(other); }
    WorkMemory& operator=(WorkMemory&& other) noexcept {
        std::swap(workspace_, other.workspace_);
        std::swap(block_, other.block_);
        std::swap(data_, other.data_);
        return *this;
    }
    WorkMemory(const WorkMemory&) = delete;
    WorkMemory& operator=(const WorkMemory&) = delete;

    [[nodiscard]] void* data() const { return data_; }

  private:
    Workspace* workspace_ = nullptr;
    Workspace::Block block_;
    void* data_ = nullptr;
};

/// An array of `count` numbers or plain structs whose values are undefined until they are written.
template <typename T>
class WorkArray {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

  public:
    WorkArray() = default;
    explicit WorkArray(std::size_t count) : memory_(count * sizeof(T)), size_(count) {}
    WorkArray(std::size_t count, const T& value) : WorkArray(count) {
        std::fill_n(data(), count, value);
    }

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] T* data() { return static_cast<T*>(memory_.data()); }
    [[nodiscard]] const T* data() const { return static_cast<const T*>(memory_.data()); }
    [[nodiscard]] T* begin() { return data(); }
    [[nodiscard]] T* end() { return data() + size_; }
    [[nodiscard]] const T* begin() const { return data(); }
    [[nodiscard]] const T* end() const { return data() + size_; }
    [[nodiscard]] T& operator[](std::size_t i) { return data()[i]; }
    [[nodiscard]] const T& operator[](std::size_t i) const { return data()[i]; }

  private:
    WorkMemory memory_;
    std::size_t size_ = 0;
};

}  // namespace detail
}  // namespace relief
