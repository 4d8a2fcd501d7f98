// SPDX-License-Identifier: Apache-2.0
/// \file
/// The contribution of one triangle to the normals at its corners: its own normal, weighted.
///
/// The formulas are written once, without branches, for several number types: normal_sums.cpp
/// compiles them for many triangles at once, normals.cpp for one. With edges e1 and e2 and angle a
/// at a corner, and area vector n = e1 x e2, the contribution is n times
///
///     uniform     1 / |n|              [Gouraud 1971]
///     area        1
///     angle       a / |n|              [Thürmer and Wüthrich 1998]
///     sine        1 / (|e1| |e2|)      equals n / |n| times the sine of a
///     max         1 / (|e1| |e2|)^2    [Max 1999]
///     angle_edges a |e1| |e2| / |n|
///     area_angle  a
#pragma once

#include <array>
#include <cmath>

#include "portable_math.h"
#include "relief/mesh/normals.h"

namespace relief::detail {

template <typename Real>
struct TriangleContributions {
    std::array<Real, 3> area_vector;  ///< Its length is twice the area.
    std::array<Real, 3> factor;       ///< Contributions are the area vector times these factors.
    /// Upper bound of the product of any two edge lengths. The rounding error of the area vector is
    /// some units in the last place of this, however narrow the triangle is.
    Real edge_product;
    bool sound;  ///< Finite and clearly not degenerate. If false, the other members are undefined.
};

/// Returns the minimal ratio of area vector to squared edge length of a clearly valid triangle: far
/// enough above the limit of degenerate triangles (min_triangle_width) for rounding not to matter.
/// In float it also keeps two correct digits of the area vector.
template <typename Real>
constexpr Real plainly_sound_width() {
    return std::is_same_v<Real, float> ? Real(1e-5) : Real(4e-12);
}

/// Contributions of the triangle a, b, c.
template <NormalWeight weight, typename Real, typename Point>
RELIEF_INLINE TriangleContributions<Real> triangle_contributions(const Point& a, const Point& b,
                                                                 const Point& c, Real scale) {
    const Real ux = (Real(b[0]) - Real(a[0])) * scale, vx = (Real(c[0]) - Real(a[0])) * scale,
               wx = (Real(c[0]) - Real(b[0])) * scale;
    const Real uy = (Real(b[1]) - Real(a[1])) * scale, vy = (Real(c[1]) - Real(a[1])) * scale,
               wy = (Real(c[1]) - Real(b[1])) * scale;
    const Real uz = (Real(b[2]) - Real(a[2])) * scale, vz = (Real(c[2]) - Real(a[2])) * scale,
               wz = (Real(c[2]) - Real(b[2])) * scale;
    const Real uu = ux * ux + uy * uy + uz * uz;
    const Real vv = vx * vx + vy * vy + vz * vz;
    const Real ww = wx * wx + wy * wy + wz * wz;

    TriangleContributions<Real> contributions;
    const Real nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    const Real squares = uu + vv + ww;
    const Real area_squared = nx * nx + ny * ny + nz * nz;
    constexpr Real width = plainly_sound_width<Real>();
    // The condition is false for NaN, and for values that would underflow in float.
    contributions.sound = area_squared > width * width * (squares * squares) &&
                          (!std::is_same_v<Real, float> || squares > Real(1e-13));
    contributions.area_vector = {nx, ny, nz};
    contributions.edge_product = squares * Real(0.5);

    using std::sqrt;
    const Real uv = ux * vx + uy * vy + uz * vz;
    const Real uw = -(ux * wx + uy * wy + uz * wz);
    const Real vw = vx * wx + vy * wy + vz * wz;
    const Real area = sqrt(area_squared);
    if constexpr (weight == NormalWeight::uniform) {
        contributions.factor = {1 / area, 1 / area, 1 / area};
    } else if constexpr (weight == NormalWeight::area) {
        contributions.factor = {Real(1), Real(1), Real(1)};
    } else if constexpr (weight == NormalWeight::sine) {
        contributions.factor = {1 / sqrt(uu * vv), 1 / sqrt(uu * ww), 1 / sqrt(vv * ww)};
    } else if constexpr (weight == NormalWeight::max) {
        contributions.factor = {1 / (uu * vv), 1 / (uu * ww), 1 / (vv * ww)};
    } else {
        contributions.factor = {upper_angle(area, uv), upper_angle(area, uw),
                                upper_angle(area, vw)};
        if constexpr (weight == NormalWeight::angle) {
            contributions.factor = {contributions.factor[0] / area, contributions.factor[1] / area,
                                    contributions.factor[2] / area};
        } else if constexpr (weight == NormalWeight::angle_edges) {
            contributions.factor = {contributions.factor[0] * (sqrt(uu * vv) / area),
                                    contributions.factor[1] * (sqrt(uu * ww) / area),
                                    contributions.factor[2] * (sqrt(vv * ww) / area)};
        }
    }
    return contributions;
}

/// Calls body.operator()<weight>() with the weight as a compile-time constant.
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

}  // namespace relief::detail
