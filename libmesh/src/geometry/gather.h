// SPDX-License-Identifier: Apache-2.0
/// \file
/// Gathers the corners of four triangles at a time into arrays by component, for loops on whole
/// vector registers; and transposes results.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>
#include <limits>
#include <span>

#include "compiler.h"
#include "portable_math.h"
#include "relief/mesh/buffers.h"

namespace relief::detail {

/// Smallest and largest vertex index of some triangles.
struct VertexRange {
    std::uint32_t lowest;
    std::uint32_t highest;
};

/// \param triangles  at least one
RELIEF_INLINE VertexRange range_of(std::span<const glm::uvec3> triangles) {
    std::uint32_t lowest = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t highest = 0;
    const std::uint32_t* index = &triangles[0].x;
    for (std::size_t i = 0; i < 3 * triangles.size(); ++i) {
        lowest = index[i] < lowest ? index[i] : lowest;
        highest = index[i] > highest ? index[i] : highest;
    }
    return {lowest, highest};
}

/// Returns some triangles in memory, with indices of 32 bits; indices of 16 bits are converted into
/// `wide`.
RELIEF_INLINE std::span<const glm::uvec3> block_of(const TriangleSpan& triangles, std::size_t first,
                                                   std::size_t size, std::span<glm::uvec3> wide) {
    if (triangles.longs() != nullptr) return {triangles.longs() + first, size};
    for (std::size_t i = 0; i < size; ++i)
        wide[i] = triangles[first + i];
    return {wide.data(), size};
}

// Four numbers in a register of every processor, and four doubles, which the compiler splits on
// processors with smaller registers.
using FourFloats = Vector<float, 16>;
using FourInts = Vector<std::int32_t, 16>;
using FourDoubles = Vector<double, 32>;

/// Transposes a matrix of four rows.
template <typename Row>
RELIEF_INLINE void transpose(Row& a, Row& b, Row& c, Row& d) {
    const Row low_ab = __builtin_shufflevector(a, b, 0, 4, 1, 5);
    const Row low_cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
    const Row high_ab = __builtin_shufflevector(a, b, 2, 6, 3, 7);
    const Row high_cd = __builtin_shufflevector(c, d, 2, 6, 3, 7);
    a = __builtin_shufflevector(low_ab, low_cd, 0, 1, 4, 5);
    b = __builtin_shufflevector(low_ab, low_cd, 2, 3, 6, 7);
    c = __builtin_shufflevector(high_ab, high_cd, 0, 1, 4, 5);
    d = __builtin_shufflevector(high_ab, high_cd, 2, 3, 6, 7);
}

/// Loads the value of one corner of four triangles, by component. Each value is loaded together
/// with the following number, which must exist.
RELIEF_INLINE void gather_four(const StridedSpan<const glm::vec3>& values,
                               const glm::uvec3* triangles, int corner, float* x, float* y,
                               float* z) {
    const auto* const first = reinterpret_cast<const std::byte*>(values.data());
    const std::size_t stride = values.stride();
    FourFloats a, b, c, d;
    std::memcpy(&a, first + stride * triangles[0][corner], sizeof a);
    std::memcpy(&b, first + stride * triangles[1][corner], sizeof b);
    std::memcpy(&c, first + stride * triangles[2][corner], sizeof c);
    std::memcpy(&d, first + stride * triangles[3][corner], sizeof d);
    transpose(a, b, c, d);
    std::memcpy(x, &a, sizeof a);
    std::memcpy(y, &b, sizeof b);
    std::memcpy(z, &c, sizeof c);
}

}  // namespace relief::detail
