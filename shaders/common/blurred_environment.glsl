// SPDX-License-Identifier: Apache-2.0
// The surroundings in a direction of world space, blurred as GGX facets of this roughness do: each
// level of the map is prefiltered for one roughness, evenly spaced. Source: [Karis, SIGGRAPH 2013].

#include "common/environment_intensity.glsl"

uniform samplerCube blurred_environment;
uniform float blurred_levels;  // The last level's number, which stands for roughness 1.

vec3 blurred_radiance(vec3 direction_world, float roughness) {
    return textureLod(blurred_environment, direction_world, roughness * blurred_levels).rgb *
           environment_intensity;
}
