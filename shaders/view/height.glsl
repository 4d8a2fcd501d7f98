// SPDX-License-Identifier: Apache-2.0
// The height that a bump map holds.

#include "common/texcoord.glsl"

uniform sampler2D bump_texture;

vec3 view_color() { return vec3(texture(bump_texture, texcoord_surface).r); }
