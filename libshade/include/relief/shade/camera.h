// SPDX-License-Identifier: Apache-2.0
/// \file
/// Defines cameras, and computes those that see a box or a scene.
///
/// World space is right-handed, y up. Angles are radians.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "relief/export.h"
#include "relief/mesh/mesh.h"

namespace RELIEF_API relief {
namespace shade {

/// A camera that looks along its own -z.
struct Camera {
    glm::mat4 world_from_view{1.0F};  ///< Rotation and translation only.
    float vertical_fov = 0.8F;
    float near = 0.1F;
    float far = 100.0F;
    /// The height of the picture in world units. If present, the projection is orthographic and
    /// vertical_fov has no effect.
    std::optional<float> orthographic_height = std::nullopt;

    friend bool operator==(const Camera&, const Camera&) = default;
};

struct Scene;

/// Checks that a camera's matrix is finite, that its field of view or its orthographic height is
/// valid, and that it has a depth range. \throws InvalidInput naming the first error
void validate(const Camera& camera);

/// The direction and field of view of the default camera, in radians.
inline constexpr float default_azimuth = 0.523598776F;       // 30 degrees
inline constexpr float default_elevation = 0.34906585F;      // 20 degrees
inline constexpr float default_vertical_fov = 0.610865238F;  // 35 degrees

/// Computes a camera that sees a whole box, for any aspect ratio.
///
/// \param azimuth  radians from +z towards +x, to the position of the camera
/// \param elevation  radians above the horizon
/// \param aspect  width / height of the picture
/// \return near and far enclose the box closely; for an empty box or one without extent, a camera
///         at distance 1 from its center (the origin for an empty box)
/// \throws InvalidInput if an angle or the aspect is not finite, the aspect is not positive, or the
///         field of view is not within (0, pi)
Camera framed(const Bounds& world, float azimuth, float elevation, float vertical_fov,
              float aspect);

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

/// Returns an orthographic camera with the position and the depth range of another camera. Its
/// height is the smallest that shows every finite vertex, with a small margin; 1 for a scene
/// without extent.
///
/// \param aspect  width / height of the picture, positive
Camera orthographic(const Scene& scene, Camera camera, float aspect);

/// Moves a camera along its line of sight: its distance from `target` is multiplied by `factor`.
/// The depth range moves along and still contains the same objects. The height of an orthographic
/// camera is multiplied instead.
Camera at_distance(Camera camera, const glm::vec3& target, float factor);

}  // namespace shade
}  // namespace relief
