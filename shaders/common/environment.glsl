// SPDX-License-Identifier: Apache-2.0
// The surroundings in a direction of world space.

#include "common/environment_intensity.glsl"

uniform samplerCube environment;

vec3 environment_radiance(vec3 direction_world) {
    return texture(environment, direction_world).rgb * environment_intensity;
}
