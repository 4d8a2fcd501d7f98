// SPDX-License-Identifier: Apache-2.0
/// \file
/// Flattens charts until none overlaps itself and none is stretched above a limit, and divides
/// those for which that fails.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "atlas/charts.h"
#include "atlas/flatten.h"
#include "atlas/injectivity.h"

namespace relief::detail {

/// A chart in the plane, in the unit of the surface; y points up.
struct FlatChart {
    ChartMesh mesh;
    std::vector<glm::dvec2> coordinates;  ///< At least 0; the box begins at the origin.
    glm::dvec2 size{0.0};
    double area = 0.0;  ///< Of the surface.
};

/// The method that flattens charts, and the limits of a chart in the plane.
struct FlatnessLimits {
    Flattening method = Flattening::arap;
    /// The largest permitted ratio of a triangle's singular values, and of its areas.
    double max_stretch = 4.0;
    /// Lattice units of a unit of the surface.
    double lattice_scale = 1.0;
    double texel = 0.0;    ///< In the unit of the surface.
    double padding = 0.0;  ///< Texels between charts.
    /// Longer charts are divided, because the map would have to shrink for them.
    double max_side = std::numeric_limits<double>::infinity();
};

/// Triangles below this share of the whole area may be stretched, because their corners are
/// rounded. A millionth, but at most a tenth of the mean triangle.
inline double min_area_share(std::size_t face_count) {
    return std::min(1e-6, 0.1 / static_cast<double>(face_count));
}

/// Rotates a chart so that the area of its box is smallest, and shifts the box to the origin.
void align_to_box(FlatChart& chart);

/// Rounds coordinates to the lattice.
std::vector<LatticePoint> on_lattice(std::span<const glm::dvec2> coordinates, double scale);

/// Flattens all charts, and merges small ones. Charts that cannot be flattened are divided within
/// narrower limits of their normals, and at last in halves.
/// \param members  of the charts of the segmentation, all with part 0
/// \return in a fixed order. Each chart is injective on the lattice and within the limits
std::vector<FlatChart> flat_charts(const AtlasSurface& surface, Segmentation& segmentation,
                                   ChartMembers& members, const FlatnessLimits& limits);

/// Returns the mean of the symmetric Dirichlet energy of a chart by area, relative to that of an
/// isometric map; it is 1 if nothing is stretched, and may be infinite.
double energy_of(const AtlasSurface& surface, const FlatChart& chart);

/// Returns the largest stretch of the triangles of a chart for which the limit holds, as a ratio of
/// singular values or of areas. \param total_area  of the surface
double largest_stretch(const AtlasSurface& surface, const FlatChart& chart, double total_area);

/// Flattens a connected union of charts.
/// \param faces  ascending, of one chart of `members`. \param total_area  of the surface
/// \param max_energy  the largest permitted energy_of()
/// \return none if it overlaps itself or exceeds the limits
std::optional<FlatChart> flattened_union(const AtlasSurface& surface, ChartMembers& members,
                                         std::vector<std::uint32_t> faces,
                                         const FlatnessLimits& limits, double total_area,
                                         double max_energy);

/// Merges small charts with neighbors as long as the unions can be flattened. The number of
/// attempts is bounded, so that the time stays linear.
std::vector<FlatChart> merged_charts(const AtlasSurface& surface, ChartMembers& members,
                                     const FlatnessLimits& limits, std::vector<FlatChart> charts);

/// Cuts charts along straight lines where that saves more room in the map than the length of the
/// cut is worth. Coordinates stay as they are, but for rotations.
std::vector<FlatChart> cut_charts(const AtlasSurface& surface, ChartMembers& members,
                                  const FlatnessLimits& limits, std::vector<FlatChart> charts);

/// Divides a chart of more than one face at `face`, an index of the chart.
std::vector<FlatChart> divided_further(const AtlasSurface& surface, ChartMembers& members,
                                       const FlatChart& chart, std::uint32_t face,
                                       const FlatnessLimits& limits);

}  // namespace relief::detail
