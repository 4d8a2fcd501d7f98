// SPDX-License-Identifier: Apache-2.0
// The highlight where the normal halves the angle between light and eye. Where those are opposite
// there is no half vector: it counts as perpendicular to the normal. Source: [Blinn 1977].

#include "common/cosine_power.glsl"
#include "common/normalized_or.glsl"
#include <sharpness>

uniform vec3 specular_color;
uniform float shininess;

vec3 specular_highlight(Surface surface, vec3 light_world) {
    vec3 half_world = normalized_or(light_world + surface.view_world, vec3(0.0));
    return specular_color * dimmed(shininess) *
           cosine_power(surface.normal_world, half_world, sharpened(shininess));
}
