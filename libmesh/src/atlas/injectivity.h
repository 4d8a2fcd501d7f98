// SPDX-License-Identifier: Apache-2.0
/// \file
/// Proves in integers that no two triangles of a chart overlap.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "atlas/flatten.h"

namespace relief::detail {

/// A chart on the lattice: y points up. Numbers are at least 0 and below 2^26, so that the
/// orientation of three points is exact in 64 bits.
using LatticePoint = glm::ivec2;

/// Returns twice the signed area of a triangle, exactly.
inline std::int64_t orientation(const LatticePoint& a, const LatticePoint& b,
                                const LatticePoint& c) {
    const auto difference = [](int x, int y) { return std::int64_t{x} - y; };
    return difference(b.x, a.x) * difference(c.y, a.y) -
           difference(b.y, a.y) * difference(c.x, a.x);
}

/// Tests whether a connected chart is injective.
///
/// The number of triangles over a point is the sum of the winding numbers of the border loops. If
/// every triangle is positive, border edges meet only at common ends, and exactly one border loop
/// is counter-clockwise, then this number is 0 or 1.
///
/// \param points  for each vertex of the chart
/// \return the index (in `chart.faces`) of a face where a condition fails; none if the chart is
///         injective
std::optional<std::uint32_t> overlap_in(const ChartMesh& chart,
                                        std::span<const LatticePoint> points);

}  // namespace relief::detail
