// SPDX-License-Identifier: Apache-2.0
#include "atlas/chart_outline.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace relief::detail {

Outline outline_of(const FlatChart& chart, const glm::dvec2& direction) {
    Outline outline;
    outline.direction = direction;
    outline.low = glm::dvec2(std::numeric_limits<double>::infinity());
    glm::dvec2 high(-std::numeric_limits<double>::infinity());
    outline.border.reserve(static_cast<std::size_t>(
        std::count(chart.mesh.opposite.begin(), chart.mesh.opposite.end(), no_corner)));
    for (Corner corner = 0; corner < chart.mesh.opposite.size(); ++corner) {
        if (chart.mesh.opposite[corner] != no_corner) continue;
        const glm::uvec3& v = chart.mesh.vertices[corner / 3];
        const auto point = [&](Corner i) {
            return rotated(chart.coordinates[v[static_cast<glm::length_t>(i % 3)]], direction);
        };
        const BorderSegment segment(point(corner), point(corner + 1));
        // Borders are loops, so that each point is the first one of a segment.
        outline.low = glm::min(outline.low, segment.first);
        high = glm::max(high, segment.first);
        outline.border.push_back(segment);
    }
    for (auto& [a, b] : outline.border) {
        a -= outline.low;
        b -= outline.low;
    }
    outline.size = high - outline.low;
    return outline;
}

CellMask mask_of(const Outline& outline, double scale, const Margin& margin, int cell) {
    return mask_of(outline.border, outline.size, margin, cell, scale);
}

}  // namespace relief::detail
