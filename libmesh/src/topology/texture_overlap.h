// SPDX-License-Identifier: Apache-2.0
/// \file
/// Finds triangles that share texels.
///
/// Texture coordinates are used as stored. Triangles that are not finite or have no area in the
/// image overlap nothing. The time is nearly linear; see texture_overlap.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace relief {

struct TextureOverlap {
    std::vector<std::uint8_t> overlapping;  ///< Per triangle: 1 if it shares a texel.
    int raster = 0;                         ///< Texels along each side of the raster.
};

/// Two triangles overlap if the center of a texel lies inside both, at least a thousandth of a
/// texel from every edge, so that rounding does not make neighbors overlap. The raster covers the
/// bounding box of all finite texture coordinates.
TextureOverlap texture_overlap(std::span<const glm::vec2> texcoords,
                               std::span<const glm::uvec3> triangles);

}  // namespace relief
