// SPDX-License-Identifier: Apache-2.0
// Exposure and tone curves, by channel.

#part exposure
// Radiance times the scene's exposure.

uniform float exposure;

vec3 exposed(vec3 radiance) { return radiance * exposure; }

#part reinhard
// A curve that stays below 1. Source: [Reinhard et al. 2002], equation 3.

#include "output.glsl#limited"

vec3 toned(vec3 radiance) {
    vec3 x = limited(radiance, 1e9);
    return x / (vec3(1.0) + x);
}

#part aces
// A rational fit to the ACES reference rendering, similar to film. Source: [Narkowicz 2016].

#include "output.glsl#limited"

vec3 toned(vec3 radiance) {
    vec3 x = limited(radiance, 1e9);
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}
