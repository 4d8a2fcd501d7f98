// SPDX-License-Identifier: Apache-2.0
/// \file
/// What is between the texels of an image on a mesh: decoded first, then filtered, in double. As
/// OpenGL defines it at full size: texel centres are at halves, and beyond the border the image
/// goes on as the texture says. A coordinate that is not finite looks up the first texel.
/// Tests: tests/mesh/bake/high_detail_test.cpp.
#pragma once

#include <glm/glm.hpp>

#include "relief/mesh/high_detail.h"

namespace relief {

/// Linear RGB.
glm::dvec3 color_at(const SurfaceTexture& texture, const glm::dvec2& texcoord);

/// Of any length, x and y scaled, y up.
glm::dvec3 normal_at(const SurfaceNormalMap& map, const glm::dvec2& texcoord);

/// \throws InvalidInput if an image is missing or empty, or has too few channels for its use, or if
///         the mesh's ranges name a material that is not there, or texture coordinates are not one
///         for each vertex
void check(const HighDetail& detail);

}  // namespace relief
