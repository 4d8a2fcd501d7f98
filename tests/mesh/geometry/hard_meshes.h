// SPDX-License-Identifier: Apache-2.0
/// \file
/// Small meshes that break naive code, all valid (mesh.h) and with normals and texture coordinates.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "relief/mesh/mesh.h"

namespace relief::test {

struct NamedMesh {
    std::string name;
    Mesh mesh;
};

/// Degenerate, folded, non-manifold, huge, tiny, far away, non-finite, badly textured.
std::vector<NamedMesh> hard_meshes();

/// The mesh with its triangles in another order: triangle i is triangle order[i] of the original.
Mesh with_triangle_order(const Mesh& mesh, const std::vector<std::size_t>& order);

/// A fixed permutation of 0 .. count-1 that leaves little in place.
std::vector<std::size_t> shuffled(std::size_t count);

/// Corner values in the same other order: three for each triangle.
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

/// What tangents.h promises for any input: every tangent finite, unit and perpendicular to its
/// normal within 1e-6 (floats of unit vectors resolve 6e-8), w = +1 or -1, the same all over a
/// triangle. A normal without direction binds nothing.
void expect_tangent_invariants(const Mesh& mesh, const std::vector<glm::vec4>& tangents);

}  // namespace relief::test
