// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which triangles share texels.
///
/// Texture coordinates as they are, u and v. Triangles that are not finite or have no area in the
/// image overlap nothing. Near-linear time: see texture_overlap.cpp.
/// Tests: tests/mesh/geometry/health/texture_overlap_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace relief {

struct TextureOverlap {
    std::vector<std::uint8_t> overlapping;  ///< By triangle: 1 where it shares a texel.
    int raster = 0;                         ///< Texels along each side of what was looked at.
};

/// Two triangles overlap when the centre of a texel lies inside both, further from every edge than
/// a thousandth of a texel, so that neighbours do not for rounding. The raster is stretched over
/// the box of all finite texture coordinates.
TextureOverlap texture_overlap(std::span<const glm::vec2> texcoords,
                               std::span<const glm::uvec3> triangles);

}  // namespace relief
