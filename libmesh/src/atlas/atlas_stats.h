// SPDX-License-Identifier: Apache-2.0
/// \file
/// Measures texture coordinates on the surface of an atlas.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "atlas/surface.h"
#include "relief/mesh/unwrap.h"

namespace relief::detail {

/// The coordinates of a surface. Faces without a chart are not measured.
struct FaceCharts {
    std::vector<std::uint32_t> chart;  ///< For each face; no_face if it has none.
    std::size_t count = 0;             ///< Of charts.
};

/// For each face, its first triangle in the mesh.
std::vector<std::uint32_t> triangles_of_faces(const AtlasSurface& surface);

/// The corners of a face in texels, y up.
std::array<glm::dvec2, 3> texels_of(std::span<const glm::vec2> corner_texcoords,
                                    const AtlasSurface& surface, std::uint32_t triangle,
                                    const glm::ivec2& size);

/// Returns AtlasStats::safe_mip_level. \param distance  of charts in texels; rounding may make it
/// up to a thousandth too small
std::optional<int> safe_mip_level(double distance);

/// Measures all but what depends on the padding. `used` is the share of one map.
/// \param corner_texcoords  three for each triangle of the mesh
AtlasStats stats_of(const AtlasSurface& surface, std::span<const glm::vec2> corner_texcoords,
                    const FaceCharts& charts, const glm::ivec2& size);

}  // namespace relief::detail
