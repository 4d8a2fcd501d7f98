// SPDX-License-Identifier: Apache-2.0
// Replaces a part of shaders/ambient.glsl: the occlusion texture is behind a branch.

//@part occlusion implements occlusion
//@include "inputs.glsl#texcoord"

uniform sampler2D occlusion_texture;
uniform float occlusion_strength;
uniform int use_occlusion_texture;

float occlusion() {
    if (use_occlusion_texture == 0) return 1.0;
    return 1.0 + occlusion_strength * (texture(occlusion_texture, texcoord_surface).r - 1.0);
}
