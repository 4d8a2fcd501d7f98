// SPDX-License-Identifier: Apache-2.0
/// \file
/// The orbit camera of the window: mouse movement, framing, picking, and its form as command-line
/// options. World space, y up; radians in code, degrees in text.
/// Tests: tests/tools/window/orbit_camera_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "relief/shade/scene.h"
#include "view_options.h"

namespace relief::tools {

/// A camera that looks at a target.
struct OrbitCamera {
    glm::vec3 target{0.0F};
    float azimuth = 0.0F;    ///< From +z towards +x, of the camera seen from the target.
    float elevation = 0.0F;  ///< Above the horizon, -90 to 90 degrees.
    float distance = 1.0F;   ///< From the target; positive.
    float vertical_fov = 0.610865238F;
    /// Parallel projection. The size at the target is that of a perspective camera.
    bool orthographic = false;

    friend bool operator==(const OrbitCamera&, const OrbitCamera&) = default;
};

/// The limits of vertical_fov in the window.
inline constexpr float min_fov_degrees = 2.0F;
inline constexpr float max_fov_degrees = 150.0F;

/// The bounding sphere of a model.
struct BoundingSphere {
    glm::vec3 center{0.0F};
    float radius = 1.0F;  ///< Always positive.
};
BoundingSphere bounding_sphere(const Bounds& bounds);

/// The camera for the renderer. The near and far planes enclose the sphere, and their ratio is
/// limited to keep the depth precision.
shade::Camera camera_of(const OrbitCamera& orbit, const BoundingSphere& sphere);

/// The same camera with the near and far planes for another sphere.
shade::Camera with_depth_range(shade::Camera camera, const BoundingSphere& sphere);

/// The camera of --camera AZIMUTH,ELEVATION@X,Y,Z,DISTANCE.
OrbitCamera orbit_of(const CameraOption& option, const CameraPlace& place, float vertical_fov,
                     bool orthographic);

/// The orbit of another camera, around the point of its axis that is nearest to the center of the
/// sphere.
OrbitCamera orbit_of(const shade::Camera& camera, const BoundingSphere& sphere);

/// Orbits by a drag in pixels. A drag over the height of the view rotates by 180 degrees. The
/// elevation is limited to the poles.
void orbit_by(OrbitCamera& orbit, const glm::vec2& pixels, int view_height);

/// Moves target and camera so that points at the distance of the target follow the pointer.
void pan_by(OrbitCamera& orbit, const glm::vec2& pixels, int view_height);

/// Zooms by steps of 10 %, in or (if negative) out. The point under the pointer stays.
///
/// \param pointer  relative to the center of the view, in halves of its height, y up
void zoom_by(OrbitCamera& orbit, float steps, const glm::vec2& pointer,
             const BoundingSphere& sphere);

/// Looks at the center of the sphere from the distance that shows all of it.
void fit(OrbitCamera& orbit, const BoundingSphere& sphere, float aspect);

/// For example "30,20@0,0.5,0,3.2": azimuth and elevation in degrees, target, distance.
/// parse_camera() reads back the same bits.
std::string to_text(const OrbitCamera& orbit);

/// An angle in degrees, with enough digits to read back the same bits.
std::string degrees_text(float radians);

/// A ray; `direction` may have any positive length.
struct Ray {
    glm::vec3 origin{0.0F};
    glm::vec3 direction{0.0F, 0.0F, -1.0F};
};

/// \param pointer  relative to the center of the view, in halves of its height, y up
Ray ray_through(const shade::Camera& camera, const glm::vec2& pointer);

/// The nearest hit of a ray with a triangle, from either side. Transparent triangles count. All
/// triangles are tested, which takes some milliseconds per million. Degenerate triangles and
/// triangles with NaN are never hit.
std::optional<glm::vec3> surface_hit(const shade::Scene& scene, const Ray& ray);

/// Moves the target to a point and keeps the direction. The distance becomes the depth of the
/// point, so its size on the screen stays. Points behind the camera are ignored.
void aim_at(OrbitCamera& orbit, const glm::vec3& point);

/// A camera that was parsed from a command line.
struct ViewText {
    CameraOption camera;
    std::optional<float> vertical_fov;
    bool orthographic = false;
};

/// \param text  "--camera 30,20@0,0,0,3 --fov 35", which may contain other options, or only the
///              value of --camera
/// \throws UsageError if the text contains no valid camera
ViewText parse_view_text(const std::string& text);

}  // namespace relief::tools
