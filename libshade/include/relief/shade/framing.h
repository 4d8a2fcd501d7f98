// SPDX-License-Identifier: Apache-2.0
/// \file
/// Computes cameras that show a scene as large as possible. World space; angles in radians.
#pragma once

#include "relief/shade/scene.h"

namespace relief {

/// Computes a camera that sees every finite vertex of a scene, with a small margin. It is closer
/// than framed() of the scene's box, whose corners are mostly empty.
///
/// \param azimuth  radians from +z towards +x, to the position of the camera
/// \param elevation  radians above the horizon
/// \param aspect  width / height of the picture
/// \param distance_factor  multiplies the distance from the center of the scene's box
/// \return a valid camera. A scene without extent is seen from distance 1, multiplied by the factor
/// \throws InvalidInput as framed() of a box does, and if the factor is not positive and finite
Camera framed(const Scene& scene, float azimuth, float elevation, float vertical_fov, float aspect,
              float distance_factor = 1.0F);

/// Moves a camera along its line of sight: its distance from `target` is multiplied by `factor`.
/// The depth range moves along and still contains the same objects.
Camera at_distance(Camera camera, const glm::vec3& target, float factor);

}  // namespace relief
