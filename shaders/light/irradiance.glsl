// SPDX-License-Identifier: Apache-2.0
// Direction to and irradiance from a light that has a place. A light that touches the surface has
// no direction and does nothing; close ones give scene.h's max_light at most, so that everything
// that is multiplied with it stays finite.

#include <falloff>

const float least_distance_squared = 1e-36;
const float max_light = 1e18;

vec3 direction_to(vec3 to_light_world) {
    float squared = dot(to_light_world, to_light_world);
    return to_light_world * inversesqrt(max(squared, least_distance_squared));
}

vec3 irradiance_from(vec3 to_light_world, vec3 intensity, float inverse_range) {
    float squared = max(dot(to_light_world, to_light_world), least_distance_squared);
    return min(intensity * falloff(squared, inverse_range), vec3(max_light));
}
