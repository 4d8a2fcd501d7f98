// SPDX-License-Identifier: Apache-2.0
/// \file
/// The same triangles in other orders, and what that must not change.
#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "relief/mesh/mesh.h"

namespace relief::test {

/// The mesh with its triangles in another order: triangle i is triangle order[i] of the original.
Mesh with_triangle_order(const Mesh& mesh, const std::vector<std::size_t>& order);

/// A permutation of 0 .. count-1 that leaves little in place, the same for the same seed.
std::vector<std::size_t> shuffled(std::size_t count, std::uint32_t seed = 20240229);

/// count-1 .. 0
std::vector<std::size_t> reversed(std::size_t count);

/// Corner values in another order of triangles: three for each triangle.
std::vector<glm::vec4> corners_in_order(const std::vector<glm::vec4>& values,
                                        const std::vector<std::size_t>& order);

/// Whether two runs of floats have the same bits.
template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() &&
           std::equal(reinterpret_cast<const std::byte*>(a.data()),
                      reinterpret_cast<const std::byte*>(a.data() + a.size()),
                      reinterpret_cast<const std::byte*>(b.data()));
}

}  // namespace relief::test
