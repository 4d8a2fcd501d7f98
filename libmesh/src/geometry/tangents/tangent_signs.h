// SPDX-License-Identifier: Apache-2.0
/// \file
/// The handedness of every triangle's tangents, also of those whose texture does not tell.
/// Tests: tests/mesh/geometry/tangents/tangents_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "geometry/corners.h"
#include "geometry/tangents/tangent_vote_blocks.h"

namespace relief {

/// The w that a triangle's texture tells; 0 where it does not.
inline std::int8_t sign_of(Gradient kind) {
    return static_cast<std::int8_t>(int(kind == Gradient::upright) -
                                    int(kind == Gradient::mirrored));
}

/// The w of every triangle; nothing is stored where their textures tell.
class TriangleSigns {
  public:
    /// \param found  of every triangle, or empty if all have those that their textures tell
    TriangleSigns(std::span<const Gradient> kinds, std::vector<std::int8_t> found)
        : kinds_(kinds), found_(std::move(found)) {}

    /// 1, -1, or 0 where nothing tells.
    [[nodiscard]] std::int8_t operator[](std::size_t triangle) const {
        return found_.empty() ? sign_of(kinds_[triangle]) : found_[triangle];
    }

  private:
    std::span<const Gradient> kinds_;
    std::vector<std::int8_t> found_;
};

/// The w of every triangle. One without a gradient takes that of most triangles with one that end
/// the runs of such triangles around its vertices, since their groups could claim it; failing
/// these, of most neighbours that have found theirs first; +1 if they balance, 0 where there are
/// none at all. (The reference implementation takes that of the first group to come in the list.)
///
/// \param triangles  over welded vertices
/// \param corners    of the triangles that take part
/// \return the same for any order of triangles; linear time but for sorting the edges of vertices
///         of triangles without a gradient
TriangleSigns triangle_signs(std::span<const glm::uvec3> triangles, const CornersByVertex& corners,
                             const TriangleGradients& gradients);

}  // namespace relief
