// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tangents at vertices, averaged over groups of neighboring triangles. Object space, unit vectors.
///
/// MikkTSpace's default angular threshold of 180 degrees separates only triangles whose u or v
/// directions are exactly opposite in the plane of the normal. Such triangles occur where a texture
/// folds back on itself, as on a wall seen along its normals. The result does not depend on the
/// order of triangles, and nothing recurses. The time is that of sorting. Source: [Mikkelsen 2008].
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/corners.h"
#include "geometry/tangent_contributions.h"
#include "geometry/tangent_signs.h"

namespace relief::detail {
/// One triangle's term of a sum, and its texture directions in the plane of the normal in float
/// precision: unit or zero.
struct SidedTerm {
    TangentSum term;
    glm::vec3 along_u;
    glm::vec3 along_v;
};

/// Returns the direction of a unit vector in the plane of a unit normal, in float; zero if
/// undefined.
glm::vec3 float_direction_in_plane(const glm::vec3& vector, const glm::vec3& normal);

/// Computes for every member the sum over all members that are not opposite in u or v. The result
/// does not depend on the order of members.
///
/// Two directions are opposite if their cosine, in float, is not above -1. This is the test of the
/// reference implementation in its arithmetic, because rounding decides it. The test of every pair
/// is quadratic. For more than 64 members, directions are therefore quantized to 2^15 steps of a
/// turn, and opposite steps are opposite.
///
/// \param normal  unit, or zero: then directions are not quantized, and large groups have no
/// opposites
std::vector<TangentSum> sums_without_opposites(std::span<const SidedTerm> members,
                                               const glm::dvec3& normal);

/// Selects the contributions that are added at a vertex. Both choices separate handedness.
enum class TangentGroups {
    connected,  ///< triangles that are neighbors across edges [Mikkelsen 2008]
    all,        ///< all.
};

/// Input of the averaging. Triangles use the indices of welded vertices.
struct GroupInput {
    TangentInput mesh;
    const CornersByVertex& corners;
    const TriangleGradients& gradients;
    const TriangleSigns& signs;
    TangentGroups groups;
};

/// Fallbacks of the averaging; ascending.
struct GroupFindings {
    /// The tangents of their group cancel; they use their own triangle's.
    std::vector<Corner> cancelled;
    /// The u direction of their triangle is parallel to the normal.
    std::vector<Corner> along_normal;
    /// Pairs of a duplicate triangle (same corners, same winding) and the triangle that counts.
    struct Repeated {
        std::uint32_t triangle;
        std::uint32_t twin;

        friend bool operator<(const Repeated& a, const Repeated& b) {
            return a.triangle < b.triangle;
        }
    };
    std::vector<Repeated> repeated;
    bool all_settled = true;  ///< All corners of participating triangles have a tangent.
};

/// Replaces the contributions of corners by their tangents, in place. w is 0 if a corner has none:
/// its triangle does not participate, is a duplicate, has no sign, or its group has no
/// contribution.
GroupFindings average_groups(const GroupInput& input, std::span<glm::vec4> corners);

}  // namespace relief::detail
