// SPDX-License-Identifier: Apache-2.0
/// \file
/// How a model is shown that brings neither camera nor lamps. World space; angles in radians.
/// Tests: tests/shade/scene/default_view_test.cpp.
#pragma once

#include "relief/shade/scene.h"

namespace relief {

/// Where the camera stands (framing.h), and how much it sees.
inline constexpr float default_azimuth = 0.523598776F;       // 30 degrees
inline constexpr float default_elevation = 0.34906585F;      // 20 degrees
inline constexpr float default_vertical_fov = 0.610865238F;  // 35 degrees

/// #1e2126, linear, opaque.
inline constexpr glm::vec4 default_background{0.01299F, 0.01521F, 0.01938F, 1.0F};

/// Adds a warm key light from the upper left of the viewer, slanting so that relief shows, and a
/// dim cool one from the right; and sets the light from everywhere to a little.
void add_default_lights(Scene& scene, const Camera& camera);

}  // namespace relief
