// SPDX-License-Identifier: Apache-2.0
/// \file
/// Views of arrays in the caller's memory: interleaved vertex buffers of GLM's vectors or plain
/// floats, and index buffers of 16 or 32 bits. Functions read and write them in place, without a
/// copy.
/// Tests: tests/mesh/geometry/buffers_test.cpp.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <iterator>
#include <ranges>
#include <span>
#include <type_traits>

#include "relief/export.h"

namespace RELIEF_API relief {

/// A type of vectors with components of a type.
template <typename Vector, typename Component>
concept VectorOf = requires {
    requires std::is_same_v<typename Vector::value_type, Component>;
};

/// Values of type T in the caller's memory at equal distances, as in an interleaved vertex buffer.
/// T is const if the values are only read.
///
///     struct Vertex { glm::vec3 position; glm::vec3 normal; glm::vec2 texcoord; };
///     std::vector<Vertex> vertices = ...;
///     const StridedSpan<const glm::vec3> positions(&vertices[0].position, vertices.size(),
///                                                  sizeof(Vertex));
///
/// Contiguous arrays, such as std::vector<glm::vec3>, convert implicitly. Vectors can be viewed in
/// arrays of plain floats:
///
///     const StridedSpan<const glm::vec3> positions(floats, vertex_count, 8 * sizeof(float));
template <typename T>
class StridedSpan {
    using Byte = std::conditional_t<std::is_const_v<T>, const std::byte, std::byte>;

  public:
    StridedSpan() = default;

    /// \param first  the first value; may be null if `size` is 0
    /// \param stride  distance between values in bytes, a multiple of alignof(T); 0 repeats the
    ///         first value, which is useful for inputs only
    StridedSpan(T* first, std::size_t size, std::size_t stride = sizeof(T))
        : first_(reinterpret_cast<Byte*>(first)), size_(size), stride_(stride) {
        assert(stride % alignof(T) == 0);
    }

    /// Views vectors whose components are plain numbers, such as `const float*` for glm::vec3.
    ///
    /// \param first  the first component of the first vector; may be null if `size` is 0
    /// \param stride  as above
    template <typename Component>
    requires VectorOf<std::remove_const_t<T>, std::remove_const_t<Component>> &&
        (std::is_const_v<T> ||
         !std::is_const_v<Component>)StridedSpan(Component* first, std::size_t size,
                                                 std::size_t stride = sizeof(T))
        : StridedSpan(reinterpret_cast<T*>(first), size, stride) {}

    /// Views a contiguous array of T.
    template <std::ranges::contiguous_range Range>
    requires std::is_convertible_v<Range&&, std::span<T>> &&
        (!std::is_same_v<std::remove_cvref_t<Range>, StridedSpan>)StridedSpan(Range&& range)
        : StridedSpan(std::ranges::data(range), std::ranges::size(range)) {}

    /// Views writable values as read-only ones.
    template <typename Value>
    requires std::is_const_v<T> && std::is_same_v<const Value, T> StridedSpan(
        const StridedSpan<Value>& other)
        : StridedSpan(other.data(), other.size(), other.stride()) {}

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] bool empty() const { return size_ == 0; }
    [[nodiscard]] std::size_t stride() const { return stride_; }
    [[nodiscard]] T* data() const { return reinterpret_cast<T*>(first_); }

    T& operator[](std::size_t i) const {
        assert(i < size_);
        return *reinterpret_cast<T*>(first_ + i * stride_);
    }

  private:
    Byte* first_ = nullptr;
    std::size_t size_ = 0;
    std::size_t stride_ = sizeof(T);
};

/// The vertex indices of triangles, three for each, in an index buffer of 16 or 32 bits.
///
/// Functions refuse negative indices, as they refuse those beyond the vertices. Arrays of
/// glm::uvec3 convert implicitly.
class TriangleSpan {
  public:
    TriangleSpan() = default;

    template <std::ranges::contiguous_range Range>
    requires std::is_convertible_v<Range&&, std::span<const glm::uvec3>> TriangleSpan(
        Range&& triangles)
        : indices_(std::ranges::data(triangles)), size_(std::ranges::size(triangles)) {}

    /// \param indices  three per triangle; surplus indices at the end are ignored
    explicit TriangleSpan(std::span<const std::uint32_t> indices)
        : indices_(indices.data()), size_(indices.size() / 3) {}
    explicit TriangleSpan(std::span<const std::int32_t> indices)
        : indices_(indices.data()), size_(indices.size() / 3) {}
    explicit TriangleSpan(std::span<const std::uint16_t> indices)
        : indices_(indices.data()), size_(indices.size() / 3), is_short_(true) {}

    /// Number of triangles.
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] bool empty() const { return size_ == 0; }

    glm::uvec3 operator[](std::size_t triangle) const {
        assert(triangle < size_);
        if (!is_short_) return longs()[triangle];
        const std::uint16_t* index = shorts() + 3 * triangle;
        return {index[0], index[1], index[2]};
    }

    [[nodiscard]] TriangleSpan subspan(std::size_t first, std::size_t count) const {
        assert(first + count <= size_);
        TriangleSpan part = *this;
        part.indices_ = is_short_ ? static_cast<const void*>(shorts() + 3 * first)
                                  : static_cast<const void*>(longs() + first);
        part.size_ = count;
        return part;
    }

    /// The triangles in memory if the indices have 32 bits, else null.
    [[nodiscard]] const glm::uvec3* longs() const {
        return is_short_ ? nullptr : static_cast<const glm::uvec3*>(indices_);
    }

  private:
    [[nodiscard]] const std::uint16_t* shorts() const {
        return static_cast<const std::uint16_t*>(indices_);
    }

    const void* indices_ = nullptr;
    std::size_t size_ = 0;
    bool is_short_ = false;
};

}  // namespace relief
