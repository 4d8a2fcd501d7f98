// SPDX-License-Identifier: Apache-2.0
/// \file
/// Checks that many tests share: promises that hold for every mesh (the order of triangles changes
/// no bit; tangents are unit, perpendicular and handed), angles between directions, messages of
/// errors.
#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/glm.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "relief/mesh/mesh.h"
#include "relief/mesh/statistics.h"

namespace relief::test {

using relief::degrees_between;
/// Returns the mesh with its triangles in another order: triangle i is triangle order[i] of the
/// original.
Mesh with_triangle_order(const Mesh& mesh, const std::vector<std::size_t>& order);

/// A permutation of 0 .. count-1 that leaves few elements in place. It depends only on the seed.
std::vector<std::size_t> shuffled(std::size_t count, std::uint32_t seed = 20240229);

/// The permutation count-1 .. 0.
std::vector<std::size_t> reversed(std::size_t count);

/// Returns corner values in another order of triangles; each triangle has three values.
std::vector<glm::vec4> corners_in_order(const std::vector<glm::vec4>& values,
                                        const std::vector<std::size_t>& order);

/// Returns whether two vectors have the same bits.
template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() &&
           std::equal(reinterpret_cast<const std::byte*>(a.data()),
                      reinterpret_cast<const std::byte*>(a.data() + a.size()),
                      reinterpret_cast<const std::byte*>(b.data()));
}

/// Returns the first problem of the tangents of all corners, or an empty string.
///
/// Every tangent is finite, unit and perpendicular to its unit normal within 1e-6 (floats of unit
/// vectors resolve 6e-8). w is +1 or -1 and equal at the corners of a triangle. A zero or
/// non-finite normal restricts nothing.
std::string broken_tangents(const Mesh& mesh, const std::vector<glm::vec4>& tangents);

/// Returns the message of the Error that `call` throws, or "no error". Other exceptions pass
/// through.
template <class Error, class Call>
std::string message_of(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

inline constexpr float half_turn = std::numbers::pi_v<float>;

}  // namespace relief::test
