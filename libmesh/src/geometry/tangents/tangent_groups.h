// SPDX-License-Identifier: Apache-2.0
/// \file
/// The tangents that neighbouring triangles agree on at the vertices they share.
///
/// Object space, unit vectors. Source: [Mikkelsen 2008]. Nothing here depends on the order of
/// triangles, and nothing recurses. Tests: tests/mesh/geometry/tangents/tangents_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/corners.h"
#include "geometry/tangents/tangent_signs.h"
#include "geometry/tangents/tangent_votes.h"

namespace relief {

/// Which votes at a vertex are added up: those of one handedness, and of them
enum class TangentGroups {
    connected,  ///< of triangles that follow each other across edges [Mikkelsen 2008];
    all,        ///< all.
};

/// What the averaging works on. Triangles are over welded vertices.
struct GroupInput {
    TangentInput mesh;
    const CornersByVertex& corners;
    const TriangleGradients& gradients;
    const TriangleSigns& signs;
    TangentGroups groups;
};

/// What averaging had to make do with; ascending.
struct GroupFindings {
    std::vector<Corner> cancelled;     ///< Their group's tangents cancel: they have their own.
    std::vector<Corner> along_normal;  ///< Their triangle's u runs along the normal: no vote.
    /// A triangle with the same corners in the same order around as another, and the one among them
    /// that counts.
    struct Repeated {
        std::uint32_t triangle;
        std::uint32_t twin;

        friend bool operator<(const Repeated& a, const Repeated& b) {
            return a.triangle < b.triangle;
        }
    };
    std::vector<Repeated> repeated;
    bool all_settled = true;  ///< Every corner of triangles that take part has a tangent.
};

/// Turns the votes of corners into their tangents, in place; w is 0 where a corner has none: its
/// triangle takes no part, is repeated, has no sign, or nobody in its group has a vote.
GroupFindings average_groups(const GroupInput& input, std::span<glm::vec4> corners);

}  // namespace relief
