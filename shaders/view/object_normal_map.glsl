// SPDX-License-Identifier: Apache-2.0
// The normal in object space, from its map.

#include "view/direction_color.glsl"
#include "detail/normal_texel.glsl"

vec3 view_color() { return direction_color(normal_texel()); }
