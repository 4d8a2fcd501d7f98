// SPDX-License-Identifier: Apache-2.0
/// \file
/// The border of a chart in one rotation, for packing.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "atlas/cell_mask.h"
#include "atlas/flat_charts.h"

namespace relief::detail {

struct Outline {
    glm::dvec2 direction{1.0, 0.0};  ///< The image of the x axis.
    glm::dvec2 low{0.0};             ///< The corner of the box before it is shifted to the origin.
    glm::dvec2 size{0.0};
    std::vector<BorderSegment> border;
};

Outline outline_of(const FlatChart& chart, const glm::dvec2& direction);

/// The mask of a chart at a scale. \param cell  texels
CellMask mask_of(const Outline& outline, double scale, const Margin& margin, int cell);

/// Rotates a point by the angle of a unit vector.
inline glm::dvec2 rotated(const glm::dvec2& point, const glm::dvec2& direction) {
    return {direction.x * point.x - direction.y * point.y,
            direction.y * point.x + direction.x * point.y};
}

}  // namespace relief::detail
