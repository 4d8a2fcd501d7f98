// SPDX-License-Identifier: Apache-2.0
/// \file
/// Compares two meshes of the same surface: matches their corners and computes the angles between
/// their normals and tangents.
///
/// Corners are matched by position and texture coordinate, independent of the order of vertices and
/// triangles and of vertex splits.
/// Tests: tests/mesh/topology/compare_test.cpp.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/statistics.h"

namespace RELIEF_API relief {

struct MatchOptions {
    /// Positions match if their distance is at most this, in the unit of the meshes.
    double position_tolerance = 0.0;
    /// Texture coordinates match if u and v each differ by at most this.
    double texcoord_tolerance = 0.0;
    /// Texture coordinates must match too. Ignored unless both meshes have them.
    bool by_texcoord = true;
};

constexpr std::uint32_t no_corner_matched = std::numeric_limits<std::uint32_t>::max();

/// The corners of two meshes that correspond. A corner is 3 * triangle + (0, 1 or 2).
struct CornerMatch {
    /// For each corner of a, the corner of b, or no_corner_matched.
    std::vector<std::uint32_t> corners;
    std::vector<std::uint32_t> only_a;  ///< Triangles of a without a match, ascending.
    std::vector<std::uint32_t> only_b;
    std::size_t exact = 0;  ///< Pairs of triangles with equal values.
    std::size_t near = 0;   ///< Pairs of triangles that match only within the tolerances.
    /// Number of pairs that are ambiguous, because several triangles have the same corners.
    std::size_t ambiguous = 0;
    bool by_texcoord = false;
};

/// Matches triangles with the same three corners in the same cyclic order, whichever corner comes
/// first. Triangles with opposite winding do not match.
///
/// \return at most one match for each triangle. Equal values are matched first; the remaining
///         triangles are matched within the tolerances, nearest first. Among several triangles with
///         the same corners, those in material ranges of the same index are matched first, then in
///         the order of their normals and tangents; such pairs are counted as ambiguous. Triangles
///         with a non-finite corner do not match
///
/// The expected time is linear. If more than 256 triangles lie within a few tolerances of each
/// other, those with closer candidates are matched first, as if the tolerance were smaller; for
/// each remaining triangle at most 256 candidates are examined.
/// \throws InvalidInput if a mesh is not valid
CornerMatch match_corners(const Mesh& a, const Mesh& b, const MatchOptions& options = {});

/// The differences at each corner of mesh a.
struct CornerDifferences {
    /// Angles in degrees; NaN if a direction is zero or not finite, negative without a match. Empty
    /// if one of the meshes lacks the attribute.
    std::vector<float> normals;
    std::vector<float> tangents;
    std::vector<unsigned char> sign_differs;  ///< 1 if the signs of the tangents' w differ.
};

CornerDifferences corner_differences(const Mesh& a, const Mesh& b, const CornerMatch& match);

struct WorstCorner {
    std::uint32_t corner_a = 0;
    std::uint32_t corner_b = 0;
    float degrees = 0.0F;  ///< NaN if undefined, which ranks above all angles.

    friend bool operator==(const WorstCorner&, const WorstCorner&) = default;
};

/// Statistics of the differences of some triangles.
struct FrameComparison {
    std::size_t corners = 0;  ///< Number of matched corners.
    ErrorStats normals;
    ErrorStats tangents;
    std::size_t sign_differences = 0;
    /// Largest angle first; corners without a difference are omitted.
    std::vector<WorstCorner> worst_normals;
    std::vector<WorstCorner> worst_tangents;

    friend bool operator==(const FrameComparison&, const FrameComparison&) = default;
};

/// Computes the statistics of the differences of some triangles.
///
/// \param first_triangle, triangle_count  a range of triangles of mesh a
/// \param worst  maximum length of the lists of worst corners
FrameComparison compared(const CornerDifferences& differences, const CornerMatch& match,
                         std::size_t first_triangle, std::size_t triangle_count,
                         std::size_t worst = 8);

}  // namespace relief
