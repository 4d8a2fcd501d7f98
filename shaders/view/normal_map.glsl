// SPDX-License-Identifier: Apache-2.0
// The normal in tangent space, as shading has it from a map.

#include "view/direction_color.glsl"
#include <detail>

vec3 view_color() { return direction_color(normal_tangent()); }
