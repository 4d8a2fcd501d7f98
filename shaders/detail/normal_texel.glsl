// SPDX-License-Identifier: Apache-2.0
// A normal map's vector. Scale and bias carry everything that differs between maps: which code
// stands for zero, which way green grows, and the material's scale of x and y.

#include "common/texcoord.glsl"

uniform sampler2D normal_texture;
uniform vec3 normal_map_scale;
uniform vec3 normal_map_bias;

vec3 normal_texel() {
    return texture(normal_texture, texcoord_surface).xyz * normal_map_scale + normal_map_bias;
}
