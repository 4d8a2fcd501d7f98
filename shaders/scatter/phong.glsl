// SPDX-License-Identifier: Apache-2.0
// The highlight around the mirrored direction of the light. Source: [Phong 1975].

#include "common/cosine_power.glsl"
#include <sharpness>

uniform vec3 specular_color;
uniform float shininess;

vec3 specular_highlight(Surface surface, vec3 light_world) {
    vec3 mirrored_world = reflect(-light_world, surface.normal_world);
    return specular_color * dimmed(shininess) *
           cosine_power(mirrored_world, surface.view_world, sharpened(shininess));
}
