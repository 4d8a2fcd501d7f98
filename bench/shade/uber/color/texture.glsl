// SPDX-License-Identifier: Apache-2.0
// shaders/color/texture.glsl behind a branch.

#include "common/texcoord.glsl"

uniform sampler2D diffuse_texture;
uniform int use_diffuse_texture;

vec4 diffuse_texel() {
    return use_diffuse_texture != 0 ? texture(diffuse_texture, texcoord_surface) : vec4(1.0);
}
