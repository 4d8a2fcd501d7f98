// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the surroundings shed on a surface, for every way that it may face, in nine numbers a
/// colour: spherical harmonics up to order 2. World space, linear light, over pi: a white surface
/// shows the value as it is.
///
/// In pictures of real places this is within 2% of the brightest value of the true integral; for
/// one small light within 9.4% of what it sheds head on, and far from it slightly negative.
/// Source: [Ramamoorthi and Hanrahan 2001].
/// Tests: tests/shade/environment/irradiance_sh_test.cpp.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>

#include "relief/mesh/image.h"

namespace relief {

/// The irradiance over pi of a surface with the unit normal n is
///
///     c[0] + c[1] n.y + c[2] n.z + c[3] n.x + c[4] n.x n.y + c[5] n.y n.z
///          + c[6] (3 n.z^2 - 1) + c[7] n.x n.z + c[8] (n.x^2 - n.y^2)
using IrradianceSh = std::array<glm::vec3, 9>;

/// \param faces  six images in linear light, +x -x +y -y +z -z, of three float channels or more
/// \return sums in double, each texel weighted by what it covers of the sphere
/// \throws InvalidInput if the faces do not fit together or are not float, or a texel is not finite
IrradianceSh irradiance_sh(std::span<const Image> faces);

/// The polynomial at a unit normal. Not cut at 0.
glm::dvec3 irradiance_over_pi(const IrradianceSh& coefficients, const glm::dvec3& normal);

}  // namespace relief
