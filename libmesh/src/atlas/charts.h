// SPDX-License-Identifier: Apache-2.0
/// \file
/// Divides a surface into charts that can be flattened with little distortion.
///
/// Faces form small clusters first, by the increase of the error between mean normals: noise that
/// both sides have does not count, so that a noisy surface is divided like a smooth one. Clusters
/// then form charts within a cone of normals. The borders of charts are smoothed at last.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "atlas/surface.h"

namespace relief::detail {

/// The limits of the normals of a chart.
struct ChartLimits {
    double cone = 1.309;   ///< Half angle of the cone that contains all mean normals, radians.
    double spread = 0.35;  ///< Mean squared chord between the normals and their mean.
};

struct Segmentation {
    std::vector<std::uint32_t> chart;  ///< For each face.
    std::size_t count = 0;
    double cluster_size = 1.0;  ///< The usual number of faces in a small cluster.
    /// For each face, the mean normal of its small cluster, unit.
    std::vector<glm::vec3> smooth_normals;
};

/// Divides all faces.
Segmentation divided(const AtlasSurface& surface, const ChartLimits& limits);

/// Straightens the borders between charts. Charts below `min_part_area` of the whole area join a
/// neighbor; connected parts of charts become charts of their own.
void straighten_borders(const AtlasSurface& surface, Segmentation& segmentation);

inline constexpr double min_part_area = 2e-4;

/// Replaces the borders between charts by shorter and straighter ones, which prefer creases. The
/// parts of a chart need not be connected afterwards.
void replace_borders(const AtlasSurface& surface, Segmentation& segmentation);

}  // namespace relief::detail
