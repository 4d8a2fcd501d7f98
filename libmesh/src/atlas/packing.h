// SPDX-License-Identifier: Apache-2.0
/// \file
/// Packs charts into a map of exactly the requested size. Charts are shifted and rotated, never
/// mirrored.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "atlas/flat_charts.h"

namespace relief::detail {

struct PackingOptions {
    glm::ivec2 size{2048};  ///< Texels.
    int padding = 4;        ///< Texels between charts; half of it at the edges of the map.
    int alignment = 1;      ///< Charts never share a block of this many texels.
    std::optional<double> texels_per_unit;  ///< Of the surface; absent: as large as possible.
};

/// The place of a chart: first rotated about the origin, then shifted.
struct Placement {
    glm::dvec2 direction{1.0, 0.0};  ///< The image of the x axis, unit.
    glm::dvec2 offset{0.0};          ///< Texels, y up.
};

struct Packing {
    double texels_per_unit = 0.0;
    std::vector<Placement> placements;  ///< One for each chart.
};

/// \throws InvalidInput if the charts do not fit at any scale, or at the requested one
Packing packed(std::span<const FlatChart> charts, const PackingOptions& options);

/// Returns a point of a chart in texels.
glm::dvec2 placed(const glm::dvec2& point, const Placement& placement, double texels_per_unit);

}  // namespace relief::detail
