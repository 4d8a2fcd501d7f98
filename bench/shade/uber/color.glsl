// SPDX-License-Identifier: Apache-2.0
// Replaces parts of shaders/color.glsl: textures are behind branches.

//@part specular_texture implements specular_texture
//@include "inputs.glsl#texcoord"

uniform sampler2D specular_texture;
uniform int use_specular_texture;

vec3 specular_texture_color() {
    return use_specular_texture != 0 ? texture(specular_texture, texcoord_surface).rgb : vec3(1.0);
}

//@part diffuse_texture implements diffuse_texture
//@include "inputs.glsl#texcoord"

uniform sampler2D diffuse_texture;
uniform int use_diffuse_texture;

vec4 diffuse_texel() {
    return use_diffuse_texture != 0 ? texture(diffuse_texture, texcoord_surface) : vec4(1.0);
}
