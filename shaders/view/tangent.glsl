// SPDX-License-Identifier: Apache-2.0
// The tangent in world space.

#include "view/direction_color.glsl"
#include <frame>

vec3 view_color() { return direction_color(world_from_tangent()[0]); }
