// SPDX-License-Identifier: Apache-2.0
/// \file
/// Surroundings in closed form, as a formula of the direction: the truth for what mirrors show of
/// maps of them. World space, linear light.
/// Tests: tests/accuracy/surroundings_experiments_test.cpp.
#pragma once

#include <functional>
#include <glm/glm.hpp>

#include "relief/mesh/image.h"
#include "relief/shade/scene.h"

namespace relief {

/// Radiance by unit direction.
using Surroundings = std::function<glm::dvec3(const glm::dvec3& direction_world)>;

/// Waves of some degrees' length all around, and a few lamps, within [0,1]; the smallest details
/// are 3 degrees wide.
glm::dvec3 waves_and_lamps(const glm::dvec3& direction_world);

/// As a cube map: a texel is the mean of 2 x 2 directions on it.
Environment cube_map_of(const Surroundings& surroundings, int size);

/// A ball of radius 1 at the origin that mirrors all light, so near that nothing else is seen: its
/// normals are within 45 degrees of the view in a square picture.
/// \param roughness  0: a mirror
Scene mirror_ball(Environment environment, double roughness);

/// What mirror_ball() should show without roughness, by the ball's own equation.
/// \param rays_a_side  squared, the rays of a pixel
/// \return three float channels
Image true_mirror(const Surroundings& surroundings, int size, int rays_a_side);

}  // namespace relief
