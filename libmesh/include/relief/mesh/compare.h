// SPDX-License-Identifier: Apache-2.0
/// \file
/// Two meshes of the same surface, corner by corner: how far apart their normals and tangents are.
///
/// Corners are matched by position and texture coordinate, so that neither the order of vertices
/// and triangles nor where vertices are split makes a difference.
/// Tests: tests/mesh/geometry/compare/compare_test.cpp.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "relief/mesh/angle_distribution.h"
#include "relief/mesh/mesh.h"

namespace relief {

struct MatchOptions {
    /// Positions no further apart than this, in the meshes' unit, are the same.
    double position_tolerance = 0.0;
    /// The same for each of u and v.
    double texcoord_tolerance = 0.0;
    /// Whether texture coordinates matter at all. They do only where both meshes have them.
    bool by_texcoord = true;
};

constexpr std::uint32_t no_corner_matched = std::numeric_limits<std::uint32_t>::max();

/// Which corner of one mesh is which of another. A corner is 3 * triangle + (0, 1 or 2).
struct CornerMatch {
    /// For each corner of a, that of b, or no_corner_matched.
    std::vector<std::uint32_t> corners;
    std::vector<std::uint32_t> only_a;  ///< Triangles of a without a partner, ascending.
    std::vector<std::uint32_t> only_b;
    std::size_t exact = 0;  ///< Pairs of triangles whose numbers are equal,
    std::size_t near = 0;   ///< and those that are so within the tolerances.
    /// Pairs that might have been formed otherwise: several triangles with the same corners.
    std::size_t ambiguous = 0;
    bool by_texcoord = false;
};

/// Pairs triangles whose three corners are the same, whichever of them comes first; not those that
/// are the other way round.
///
/// \param a, b  valid meshes (mesh.h)
/// \return one partner at most for each triangle. Equal numbers go first; what they leave over is
///         matched within the tolerances, nearest first. Of several triangles with the same corners
///         those in material ranges of the same number go together, then those first by their
///         normals and tangents; that is counted. Triangles with a non-finite corner match nothing
///
/// Expected linear time; where more than 256 triangles crowd within a few tolerances of each other,
/// those with a partner nearer by are paired first, as if the tolerance were so narrow; of the rest
/// no more than that many are looked at for a near match.
CornerMatch match_corners(const Mesh& a, const Mesh& b, const MatchOptions& options = {});

/// What differs at each corner of mesh a.
struct CornerDifferences {
    /// Degrees; NaN where a direction is zero or not finite, negative where there is no partner.
    /// Empty where one of the meshes has no such attribute.
    std::vector<float> normals;
    std::vector<float> tangents;
    std::vector<unsigned char> sign_differs;  ///< The w of the tangents have different signs.
};

CornerDifferences corner_differences(const Mesh& a, const Mesh& b, const CornerMatch& match);

struct WorstCorner {
    std::uint32_t corner_a = 0;
    std::uint32_t corner_b = 0;
    float degrees = 0.0F;  ///< NaN: undefined, which is worse than any angle.

    friend bool operator==(const WorstCorner&, const WorstCorner&) = default;
};

/// The differences of some triangles, summed up.
struct FrameComparison {
    std::size_t corners = 0;  ///< Matched.
    AngleDistribution normals;
    AngleDistribution tangents;
    std::size_t sign_differences = 0;
    std::vector<WorstCorner> worst_normals;  ///< Worst first; none that do not differ.
    std::vector<WorstCorner> worst_tangents;

    friend bool operator==(const FrameComparison&, const FrameComparison&) = default;
};

/// \param first_triangle, triangle_count  of mesh a
/// \param worst  how many of the worst corners to name
FrameComparison compared(const CornerDifferences& differences, const CornerMatch& match,
                         std::size_t first_triangle, std::size_t triangle_count,
                         std::size_t worst = 8);

}  // namespace relief
