// SPDX-License-Identifier: Apache-2.0
/// \file
/// Where the camera stands to see a model as large as the picture allows. World space; angles in
/// radians. Tests: tests/tools/framing_test.cpp.
#pragma once

#include "relief/shade/scene.h"

namespace relief::tools {

/// A camera on its line of sight: its distance from `target` times `factor`. The depth range moves
/// along, and still ends behind what it ended behind before.
Camera at_distance(Camera camera, const glm::vec3& target, float factor);

/// How much nearer to (below 1) or farther from `target` the camera must be to see every finite
/// vertex of the scene, with a little room around them. 1 where there is no such vertex.
///
/// \param aspect  width / height of the picture
float fitting_factor(const Scene& scene, const Camera& camera, const glm::vec3& target,
                     float aspect);

}  // namespace relief::tools
