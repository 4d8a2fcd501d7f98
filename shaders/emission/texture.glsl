// SPDX-License-Identifier: Apache-2.0
// The surface's own light, by a texture decoded from sRGB by the lookup.

#include "common/texcoord.glsl"

uniform vec3 emission_color;
uniform sampler2D emission_texture;

vec3 emitted_radiance() {
    return emission_color * texture(emission_texture, texcoord_surface).rgb;
}
