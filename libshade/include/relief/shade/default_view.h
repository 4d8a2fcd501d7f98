// SPDX-License-Identifier: Apache-2.0
/// \file
/// Defines the default camera and lights of a model without its own. World space; angles in
/// radians.
#pragma once

#include "relief/shade/scene.h"

namespace relief {

/// The direction (framing.h) and field of view of the camera.
inline constexpr float default_azimuth = 0.523598776F;       // 30 degrees
inline constexpr float default_elevation = 0.34906585F;      // 20 degrees
inline constexpr float default_vertical_fov = 0.610865238F;  // 35 degrees

/// #1e2126, linear, opaque.
inline constexpr glm::vec4 default_background{0.01299F, 0.01521F, 0.01938F, 1.0F};

/// Adds a warm key light from the upper left of the viewer, at an angle that shows relief, and a
/// dim cool light from the right, and sets a small ambient light.
void add_default_lights(Scene& scene, const Camera& camera);

}  // namespace relief
