// SPDX-License-Identifier: Apache-2.0
// Texture coordinates within their unit, and a checker of 8 x 8 squares in blue.

#include "common/texcoord.glsl"

vec3 view_color() {
    vec2 square = floor(8.0 * texcoord_surface);
    return vec3(fract(texcoord_surface), mod(square.x + square.y, 2.0));
}
