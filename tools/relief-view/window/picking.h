// SPDX-License-Identifier: Apache-2.0
/// \file
/// The surface under the pointer. World space; no window and no OpenGL.
/// Tests: tests/tools/window/picking_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "relief/shade/scene.h"
#include "window/orbit_camera.h"

namespace relief::tools {

/// A ray through the picture; `direction` is of any length but 0.
struct Ray {
    glm::vec3 origin{0.0F};
    glm::vec3 direction{0.0F, 0.0F, -1.0F};
};

/// \param pointer  from the centre of the view, in halves of its height, y up
Ray ray_through(const Camera& camera, const glm::vec2& pointer);

/// The nearest place where a triangle lies on the ray, from either side, whether or not it is
/// transparent. Every triangle is looked at, once: some milliseconds for a million. Triangles
/// without area, or with a vertex that is no number, are never hit.
std::optional<glm::vec3> surface_on(const Scene& scene, const Ray& ray);

/// Looks at a point in the same direction, from as far as it appears now: the point comes to the
/// middle and keeps its size. A point behind the eye changes nothing.
void aim_at(OrbitCamera& orbit, const glm::vec3& point);

}  // namespace relief::tools
