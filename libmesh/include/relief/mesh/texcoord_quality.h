// SPDX-License-Identifier: Apache-2.0
/// \file
/// Measures the texture coordinates of a mesh: charts, seams, density, stretch, overlaps.
/// Tests: tests/mesh/atlas/texcoord_quality_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/unwrap.h"

namespace RELIEF_API relief {

/// The quality of given texture coordinates. A chart is a connected part of the surface inside of
/// which the coordinates of neighbors agree at both ends of their edge.
///
/// The map may consist of UDIM tiles: unit squares in ten columns, tile 1001 at u and v from 0 to
/// 1, 1002 to its right, and 1011 above it, up to 9999. A triangle is in a tile if all its corners
/// are.
struct TexcoordQuality {
    /// Without shared charts. Flat triangles count in the number of charts only. `used` is the
    /// share of all `tiles`; it counts texels twice where triangles overlap, so that it may be
    /// above 1.
    AtlasStats stats;
    /// Charts that share the texels of an earlier one: both have exactly the same triangles in the
    /// map, mirrored or not. Such charts do not overlap each other; all others that have an area in
    /// common do.
    std::size_t shared_charts = 0;
    std::vector<int> tiles;  ///< The numbers of the tiles that have triangles, ascending.
    /// Triangles that have an area on the surface, but none in the map, up to rounding.
    std::size_t flat = 0;
    std::size_t inverted = 0;         ///< Triangles that face another way than most of their chart.
    std::size_t overlapping = 0;      ///< Triangles that share an area of the map with another one.
    std::size_t outside = 0;          ///< Triangles that are in no tile, or in several.
    std::size_t mirrored_charts = 0;  ///< Charts that the surface shows mirrored.
    /// The least distance in a tile between two charts in texels; absent if no two charts are
    /// closer than 64 texels. `stats.safe_mip_level` is that of this distance, or of 64 texels.
    std::optional<double> min_distance;
    /// For each triangle; none if it has no area on the surface, or is not finite. Shared charts
    /// have the number of the first one.
    std::vector<std::optional<std::uint32_t>> chart;
};

/// Measures texture coordinates.
///
/// \param mesh  valid (mesh.h), with texture coordinates; vertices with equal positions count as
///         one. Coordinates are used as they are stored, without wrapping
/// \param size  of the map, or of each tile, in texels, 1 to 65536 each
/// \param report  counts triangles without area, non-finite ones (by position or coordinates) and
///         repeated ones, which are not measured, and edges of more than two triangles
/// \param first_vertices  the parts of the mesh, as UnwrapOptions::first_vertices: charts of two
///         parts are not joined where they touch
/// \return the same for any order of triangles, vertices and corners, unless repeated triangles
///         differ in their coordinates: the first one counts. Orientation and overlaps are
///         exact for the stored floats: triangles that touch do not overlap
/// \throws InvalidInput if the mesh is not valid or has no texture coordinates, the size is out of
///         range, or the first vertices do not ascend from 0
///
/// The time is nearly linear, unless very many long and thin triangles lie side by side.
///
/// Source: exact signs [Shewchuk 1997]; stretch [Sander et al. 2001].
TexcoordQuality measure_texcoords(const Mesh& mesh, const glm::ivec2& size,
                                  Report& report = IgnoredReport(),
                                  std::span<const std::uint32_t> first_vertices = {});

}  // namespace relief
