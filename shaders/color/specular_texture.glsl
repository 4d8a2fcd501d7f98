// SPDX-License-Identifier: Apache-2.0
// The colour of highlights by texture, decoded from sRGB by the lookup.

#include "common/texcoord.glsl"

uniform sampler2D specular_texture;

vec3 specular_texture_color() { return texture(specular_texture, texcoord_surface).rgb; }
