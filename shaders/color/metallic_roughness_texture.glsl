// SPDX-License-Identifier: Apache-2.0
// Metallic and roughness by texture: blue and green.

#include "common/texcoord.glsl"

uniform float metallic;
uniform float roughness;
uniform sampler2D metallic_roughness_texture;

vec2 metallic_and_roughness() {
    return texture(metallic_roughness_texture, texcoord_surface).bg * vec2(metallic, roughness);
}
