// SPDX-License-Identifier: Apache-2.0
/// \file
/// Handles in the picture, which the user can drag or click: the ends of the axes in its corner,
/// and lights. Positions on the view are relative to its center, in halves of its height, y up.
/// Tests: tests/tools/window/view_handles_test.cpp, handles_window_test.cpp.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "relief/shade/scene.h"
#include "window/edit_panels.h"
#include "window/orbit_camera.h"
#include "window/shortcuts.h"

namespace relief::tools {

/// One end of an axis of the world, as the camera sees it.
struct AxisEnd {
    Action action = Action::front;  ///< Looks along the axis from this end.
    const char* name = "";          ///< For example "+x".
    glm::vec2 direction{0.0F};      ///< On the view, y up; shorter than 1 if it points in depth.
    float depth = 0.0F;             ///< Towards the camera, -1 to 1.
};
/// The six ends, the farthest one first.
std::array<AxisEnd, 6> axis_ends(const OrbitCamera& camera);

/// The position of a point on the view. Empty if it is not in front of the camera.
std::optional<glm::vec2> projected(const shade::Camera& camera, const glm::vec3& point_world);

/// The point that stands for a light in the picture: its position, or for a directional light the
/// point of the sphere from which it shines.
glm::vec3 handle_of(const AnyLight& light, const BoundingSphere& sphere);

/// A drag of a light. A point light or spotlight moves parallel to the view; a spotlight keeps its
/// direction. The handle of a directional light moves on the sphere; leaving the outline of the
/// sphere and coming back changes between its front and its back.
class LightDrag {
  public:
    /// \param pointer  on the view
    LightDrag(const AnyLight& light, const shade::Camera& camera, const BoundingSphere& sphere,
              const glm::vec2& pointer);

    /// \return the light with its handle under the pointer
    AnyLight moved(const AnyLight& light, const shade::Camera& camera, const BoundingSphere& sphere,
                   const glm::vec2& pointer);

  private:
    glm::vec2 offset_{0.0F};  ///< From the pointer to the handle.
    bool is_behind_ = false;
    bool is_outside_ = false;
};

}  // namespace relief::tools
