// SPDX-License-Identifier: Apache-2.0
// The normal in world space.

#include "view/direction_color.glsl"
#include <normal>

vec3 view_color() { return direction_color(shading_normal()); }
