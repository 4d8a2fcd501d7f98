// SPDX-License-Identifier: Apache-2.0
/// \file
/// The camera of the window: it looks at a point and is moved by hands. World space, y up; radians
/// inside, degrees in text. No window and no OpenGL.
/// Tests: tests/tools/window/orbit_camera_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "relief/shade/scene.h"
#include "view_options.h"

namespace relief::tools {

struct OrbitCamera {
    glm::vec3 target{0.0F};
    float azimuth = 0.0F;    ///< From +z towards +x: from where it looks.
    float elevation = 0.0F;  ///< Above the horizon, -90 to 90 degrees.
    float distance = 1.0F;   ///< From the target, more than 0.
    float vertical_fov = 0.610865238F;
};

/// Where a model is, as a ball.
struct Ball {
    glm::vec3 center{0.0F};
    float radius = 1.0F;  ///< At least a little.
};
Ball ball_around(const Bounds& bounds);

/// As the renderer takes it: near and far enclose the ball, and the near plane keeps a share of the
/// far one, so that depth has a precision.
Camera camera_of(const OrbitCamera& orbit, const Ball& ball);

/// The same camera with a depth range for another ball.
Camera seeing(Camera camera, const Ball& ball);

/// As --camera AZIMUTH,ELEVATION@X,Y,Z,DISTANCE says it.
OrbitCamera orbit_of(const CameraOption& option, const CameraPlace& place, float vertical_fov);

/// The orbit on which another camera looks, at the point nearest to the ball's centre.
OrbitCamera orbit_of(const Camera& camera, const Ball& ball);

/// Turns by a drag in pixels: to the right moves the eye to the left. A drag over the height of the
/// view is half a turn; elevation stops at the poles.
void orbit_by(OrbitCamera& orbit, const glm::vec2& pixels, int view_height);

/// Moves target and eye by a drag, so that what lies as far as the target stays under the pointer.
void pan_by(OrbitCamera& orbit, const glm::vec2& pixels, int view_height);

/// Comes nearer by `steps` of a tenth (or goes farther, where negative), and keeps what is under
/// the pointer there.
///
/// \param pointer  from the centre of the view, in halves of its height, y up
void zoom_by(OrbitCamera& orbit, float steps, const glm::vec2& pointer, const Ball& ball);

/// As far away as shows all of the ball, looking at its centre.
void fit(OrbitCamera& orbit, const Ball& ball, float aspect);

/// "30,20@0,0.5,0,3.2": azimuth and elevation in degrees, target, distance; what --camera takes.
/// Reading it back gives the same camera, bit for bit.
std::string to_text(const OrbitCamera& orbit);

/// An angle with as many digits as --camera and --fov need to read it back, bit for bit.
std::string degrees_text(float radians);

}  // namespace relief::tools
