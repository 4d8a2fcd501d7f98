// SPDX-License-Identifier: Apache-2.0
/// \file
/// What one triangle says about the normals at its corners: a vector along its own normal for each,
/// longer the more it counts for.
///
/// The formulas are written once, for float, double and long double, without branches, so that
/// normal_sums.cpp can have them compiled for many triangles at once and exact_normals.cpp for one.
/// With edges e1, e2 and angle a at a corner, and area vector n = e1 x e2, the vote is n times
///
///     uniform     1 / |n|              [Gouraud 1971]
///     area        1
///     angle       a / |n|              [Thürmer and Wüthrich 1998]
///     sine        1 / (|e1| |e2|)      n / |n| times the sine of a
///     max         1 / (|e1| |e2|)^2    [Max 1999]
///     angle_edges a |e1| |e2| / |n|
///     area_angle  a
///
/// Tests: tests/mesh/geometry/normals/normals_test.cpp.
#pragma once

#include <array>
#include <cmath>

#include "geometry/corner_angle.h"
#include "relief/mesh/normals.h"
#include "vector_targets.h"

namespace relief {

template <typename Real>
struct TriangleVotes {
    std::array<Real, 3> area_vector;  ///< Twice the area long.
    std::array<Real, 3> factor;       ///< Votes are the area vector times these.
    /// At least the product of the lengths of any two edges: rounding leaves an error of some units
    /// in the last place of this in the area vector, however narrow the triangle is.
    Real edge_product;
    bool sound;  ///< Finite, and plainly not degenerate. If not, the rest says nothing.
};

/// How narrow a triangle may be, as area vector over square of edges, to be plainly sound: far
/// enough above what counts as degenerate (least_triangle_width) for rounding not to matter; and
/// in float, so wide that the area vector has two good digits.
template <typename Real>
constexpr Real plainly_sound_width() {
    return std::is_same_v<Real, float> ? Real(1e-5) : Real(4e-12);
}

/// Votes of the triangle a, b, c. \param scale  a power of two that makes floats' edges about 1
template <NormalWeight weight, typename Real, typename Point>
RELIEF_INLINE TriangleVotes<Real> triangle_votes(const Point& a, const Point& b, const Point& c,
                                                 Real scale) {
    const Real ux = (Real(b[0]) - Real(a[0])) * scale, vx = (Real(c[0]) - Real(a[0])) * scale,
               wx = (Real(c[0]) - Real(b[0])) * scale;
    const Real uy = (Real(b[1]) - Real(a[1])) * scale, vy = (Real(c[1]) - Real(a[1])) * scale,
               wy = (Real(c[1]) - Real(b[1])) * scale;
    const Real uz = (Real(b[2]) - Real(a[2])) * scale, vz = (Real(c[2]) - Real(a[2])) * scale,
               wz = (Real(c[2]) - Real(b[2])) * scale;
    const Real uu = ux * ux + uy * uy + uz * uz;
    const Real vv = vx * vx + vy * vy + vz * vz;
    const Real ww = wx * wx + wy * wy + wz * wz;

    TriangleVotes<Real> votes;
    const Real nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    const Real squares = uu + vv + ww;
    const Real area_squared = nx * nx + ny * ny + nz * nz;
    constexpr Real width = plainly_sound_width<Real>();
    // Written so that NaN is not sound; nor is what would lose digits to underflow in float.
    votes.sound = area_squared > width * width * (squares * squares) &&
                  (!std::is_same_v<Real, float> || squares > Real(1e-13));
    votes.area_vector = {nx, ny, nz};
    votes.edge_product = squares * Real(0.5);

    const Real uv = ux * vx + uy * vy + uz * vz;
    const Real uw = -(ux * wx + uy * wy + uz * wz);
    const Real vw = vx * wx + vy * wy + vz * wz;
    const Real area = std::sqrt(area_squared);
    if constexpr (weight == NormalWeight::uniform) {
        votes.factor = {1 / area, 1 / area, 1 / area};
    } else if constexpr (weight == NormalWeight::area) {
        votes.factor = {1, 1, 1};
    } else if constexpr (weight == NormalWeight::sine) {
        votes.factor = {1 / std::sqrt(uu * vv), 1 / std::sqrt(uu * ww), 1 / std::sqrt(vv * ww)};
    } else if constexpr (weight == NormalWeight::max) {
        votes.factor = {1 / (uu * vv), 1 / (uu * ww), 1 / (vv * ww)};
    } else {
        votes.factor = {upper_angle(area, uv), upper_angle(area, uw), upper_angle(area, vw)};
        if constexpr (weight == NormalWeight::angle) {
            votes.factor = {votes.factor[0] / area, votes.factor[1] / area, votes.factor[2] / area};
        } else if constexpr (weight == NormalWeight::angle_edges) {
            votes.factor = {votes.factor[0] * (std::sqrt(uu * vv) / area),
                            votes.factor[1] * (std::sqrt(uu * ww) / area),
                            votes.factor[2] * (std::sqrt(vv * ww) / area)};
        }
    }
    return votes;
}

/// Calls `body` with the weight as a constant: body.operator()<weight>().
template <typename Body>
void with_weight(NormalWeight weight, const Body& body) {
    switch (weight) {
        case NormalWeight::uniform:
            return body.template operator()<NormalWeight::uniform>();
        case NormalWeight::area:
            return body.template operator()<NormalWeight::area>();
        case NormalWeight::angle:
            return body.template operator()<NormalWeight::angle>();
        case NormalWeight::sine:
            return body.template operator()<NormalWeight::sine>();
        case NormalWeight::max:
            return body.template operator()<NormalWeight::max>();
        case NormalWeight::angle_edges:
            return body.template operator()<NormalWeight::angle_edges>();
        case NormalWeight::area_angle:
            return body.template operator()<NormalWeight::area_angle>();
    }
}

}  // namespace relief
