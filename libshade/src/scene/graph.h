// SPDX-License-Identifier: Apache-2.0
/// \file
/// The parts of scene graphs (scene_graph.h) that scene files, validation and framing share. World
/// space, radians, seconds.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>

#include "relief/shade/scene_graph.h"

namespace relief {

/// The axes of a viewer who looks at a point from a direction on the sphere. Defined at the poles
/// too.
///
/// \param azimuth    from +z towards +x
/// \param elevation  above the xz plane
/// \return right, up, and back: the unit vector towards the eye
glm::mat3 orbit_axes(double azimuth, double elevation);

/// The value of a channel at a time.
/// \return rotations as unit quaternions x, y, z, w
/// \throws InvalidInput as pose() does for keys
glm::vec4 value_at(const KeyChannel& channel, double seconds);

/// Checks that keys are as KeyChannel requires. \throws InvalidInput naming the first offence
void check_keys(const KeyChannel& channel);

/// Adds a model to a graph as a part that hangs on a node: the world of the part becomes the space
/// of the node, and its animations play along. Its ambient light is added; its camera, environment
/// and settings are not.
void append(SceneGraph& graph, SceneGraph part, std::size_t node);

}  // namespace relief
