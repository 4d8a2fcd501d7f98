// SPDX-License-Identifier: Apache-2.0
// How much of light from everywhere gets here: the texture's red, as strongly as the material says.

#include "common/texcoord.glsl"

uniform sampler2D occlusion_texture;
uniform float occlusion_strength;

float occlusion() {
    return 1.0 + occlusion_strength * (texture(occlusion_texture, texcoord_surface).r - 1.0);
}
