// SPDX-License-Identifier: Apache-2.0
/// \file
/// The surroundings as a cube map for rough mirrors: each level blurred by GGX of one roughness
/// (environment/blur.h), as if seen head on. Tests: tests/shade/gl/prefilter_test.cpp.
#pragma once

#include "gl/cube_map.h"

namespace relief::gl {

/// A cube map whose level i of n is for roughness i / (n - 1), alpha = roughness^2.
///
/// \param environment  with all of its levels
/// \return RGBA16F, 256 texels along a face and 6 levels, or 128 and 5 where the surroundings are
///         smaller than 256; the last level has 8. Level 0 is the mirror picture. To be looked up
///         by textureLod(cube, mirrored direction, roughness * (levels - 1)), seamless.
/// \throws GpuError
///
/// Takes 0.1 s on two processor cores, where all but level 0 is computed. Restores the framebuffer
/// binding and the viewport; leaves no program or vertex array bound.
CubeMap make_prefiltered(const Api& api, const CubeMap& environment);

}  // namespace relief::gl
