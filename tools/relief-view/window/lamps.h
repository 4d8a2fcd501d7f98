// SPDX-License-Identifier: Apache-2.0
/// \file
/// A scene's lamps as one list, so that one of them can become one of another kind, be turned round
/// the model, or come and go. World space, radians. Neither a window nor OpenGL.
/// Tests: tests/tools/window/lamps_test.cpp.
#pragma once

#include <variant>
#include <vector>

#include "relief/shade/scene.h"
#include "window/orbit_camera.h"

namespace relief::tools {

enum class LampKind { directional, point, spot };

/// In the order of LampKind.
using Lamp = std::variant<DirectionalLight, PointLight, SpotLight>;

LampKind kind_of(const Lamp& lamp);
const char* name_of(LampKind kind);

/// Directional ones first, then points, then spots.
std::vector<Lamp> lamps_of(const Scene& scene);

/// Takes the place of all lamps; their order within a kind is kept.
void set_lamps(Scene& scene, const std::vector<Lamp>& lamps);

/// One that lights a model of this size from the upper right.
Lamp new_lamp(LampKind kind, const Ball& ball);

/// One of another kind that sheds the same light on a surface in the ball's middle that faces it.
/// What had no place gets one outside of the ball, on the side that the light came from; a range or
/// falloff is lost with the place.
Lamp as_kind(const Lamp& lamp, LampKind kind, const Ball& ball);

/// Places and directions turned about a place.
void turn(Lamp& lamp, const glm::mat3& rotation, const glm::vec3& center);

}  // namespace relief::tools
