// SPDX-License-Identifier: Apache-2.0
/// \file
/// Light probes as angular maps: the whole sphere in a disc, by the angle from its middle.
///
/// With u to the right and v upwards in the image, both from -1 to 1, the direction (x, y, z) in
/// world space stands at (u, v) = r (x, y) / |(x, y)| with r = acos(-z) / pi: the middle is -z, the
/// rim, all of it, +z. Outside the rim there is nothing. Source: [Debevec 1998], whose probes have
/// this form. Tests: tests/shade/environment/angular_map_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <string_view>

#include "relief/mesh/image.h"

namespace relief {

/// Texels that are left out at the rim: a texel there is cut by it, and a bilinear lookup reaches
/// the next one diagonally.
inline constexpr double angular_map_rim = 1.5 * 1.41421356237309505;

/// The largest r that is looked up in a map of this width, 0 at least; what lies farther out shows
/// what is there.
double angular_map_reach(int width);

/// Where a direction of any length stands, as texture coordinates: (0, 0) the upper left corner.
glm::dvec2 angular_map_place(const glm::dvec3& direction, int width);

/// \throws InvalidInput if the image is empty or not square
void check_angular_map(const Image& image, std::string_view name);

}  // namespace relief
