// SPDX-License-Identifier: Apache-2.0
/// \file
/// Lights, cameras and surroundings of scene files. Angles are degrees there, radians here.
/// Tests: tests/shade/scene/scene_json_test.cpp.
#pragma once

#include <optional>

#include "relief/shade/scene_graph.h"
#include "scene/json_material.h"

namespace relief {

/// Adds a light, on a node or, without one, in the world; its ambient part goes to the scene.
void add_light(const JsonCursor& object, std::optional<std::size_t> node, SceneGraph& graph);

Environment environment_from(const JsonCursor& object, const JsonImages& images);

/// A camera on a node: field of view and depth range. \param sees_all  set where "far" is absent
Camera node_camera_from(const JsonCursor& object, bool& sees_all);

/// The scene's own camera: from "eye" to "target", or framing the scene as it is posed now.
/// \param aspect  of the picture
Camera camera_from(const JsonCursor& object, const Scene& scene, float aspect, bool& sees_all);

/// A number of degrees, as radians.
float degrees_in(const JsonCursor& object, const char* key, float absent_radians);

/// A member's number or vector, or this where it is absent.
float number_in(const JsonCursor& object, const char* key, float absent);
glm::vec3 vector_in(const JsonCursor& object, const char* key, const glm::vec3& absent);

}  // namespace relief
