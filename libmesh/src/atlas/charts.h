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
    /// Absolute value of the integral of Gaussian curvature, steradians.
    double curvature = 2.5;
};

struct Segmentation {
    std::vector<std::uint32_t> chart;  ///< For each face.
    std::size_t count = 0;
    std::vector<std::uint32_t> cluster;  ///< For each face, its small cluster.
    std::vector<glm::vec3> normals;      ///< The mean normal of each small cluster, unit.
    std::vector<double> curvatures;  ///< The integral of Gaussian curvature of each small cluster.

    [[nodiscard]] const glm::vec3& smooth_normal(std::uint32_t face) const {
        return normals[cluster[face]];
    }
};

/// Divides all faces.
Segmentation divided(const AtlasSurface& surface, const ChartLimits& limits);

/// Divides some faces within other limits. \param faces ascending
/// \return the number of a part for each of them, from 0; parts need not be connected
std::vector<std::uint32_t> divided_part(const AtlasSurface& surface,
                                        const Segmentation& segmentation,
                                        std::span<const std::uint32_t> faces,
                                        const ChartLimits& limits);

/// Straightens the borders between charts. Charts below `min_part_area` of the whole area join a
/// neighbor; connected parts of charts become charts of their own.
void straighten_borders(const AtlasSurface& surface, Segmentation& segmentation);

/// Connected parts of charts become charts of their own.
void separate_components(const AtlasSurface& surface, Segmentation& segmentation);

inline constexpr double min_part_area = 2e-4;

/// Replaces the borders between charts of a group by shorter and straighter ones, which prefer
/// creases. \param group  of each chart; no_face: its borders stay. Charts need not be connected
/// afterwards
void replace_borders(const AtlasSurface& surface, Segmentation& segmentation,
                     std::span<const std::uint32_t> group);

}  // namespace relief::detail
