// SPDX-License-Identifier: Apache-2.0
// The surroundings, blurred by one roughness.

#include "common/blurred_environment.glsl"

uniform float reflection_roughness;

vec3 mirror_image(vec3 direction_world) {
    return blurred_radiance(direction_world, reflection_roughness);
}
