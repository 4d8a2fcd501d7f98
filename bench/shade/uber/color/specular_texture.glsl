// SPDX-License-Identifier: Apache-2.0
// shaders/color/specular_texture.glsl behind a branch.

#include "common/texcoord.glsl"

uniform sampler2D specular_texture;
uniform int use_specular_texture;

vec3 specular_texture_color() {
    return use_specular_texture != 0 ? texture(specular_texture, texcoord_surface).rgb : vec3(1.0);
}
