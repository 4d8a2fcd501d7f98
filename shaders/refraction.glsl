// SPDX-License-Identifier: Apache-2.0
// The environment seen through the surface.

#part refracted
// Light is refracted once, at the surface; total internal reflection is black.

#include "environment.glsl#radiance"

uniform float transmission;
uniform float refraction_ratio;  // The outside's refractive index over the inside's.

vec3 with_refraction(Surface surface, vec3 scattered) {
    vec3 bent_world = refract(-surface.view_world, surface.normal_world, refraction_ratio);
    vec3 through = bent_world == vec3(0.0) ? vec3(0.0) : environment_radiance(bent_world);
    return scattered * (1.0 - transmission) + through * transmission;
}

#part dimming
// For a debug view of another term: transmission only dims the scattered light.

uniform float transmission;

vec3 with_refraction(Surface surface, vec3 scattered) { return scattered * (1.0 - transmission); }
