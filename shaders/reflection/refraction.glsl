// SPDX-License-Identifier: Apache-2.0
// The surroundings through the surface, bent once where the light enters; where it cannot, nothing
// comes through.

#include "common/environment.glsl"

uniform float transmission;
uniform float refraction_ratio;  // The outside's index over the inside's.

vec3 with_refraction(Surface surface, vec3 scattered) {
    vec3 bent_world = refract(-surface.view_world, surface.normal_world, refraction_ratio);
    vec3 through = bent_world == vec3(0.0) ? vec3(0.0) : environment_radiance(bent_world);
    return scattered * (1.0 - transmission) + through * transmission;
}
