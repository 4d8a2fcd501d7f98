// SPDX-License-Identifier: Apache-2.0
// Direction to and irradiance from a light that has a place. A light that touches the surface has
// no direction and does nothing; close ones give lights.h's max_light at most, so that everything
// that is multiplied with it stays finite.

#include <distance_law>
#include <range>

const float least_distance_squared = 1e-36;
const float max_light = 1e18;

vec3 direction_to(vec3 to_light_world) {
    float squared = dot(to_light_world, to_light_world);
    return to_light_world * inversesqrt(max(squared, least_distance_squared));
}

// The share of its intensity that a light sheds at this distance.
float reach_of(vec3 to_light_world, float inverse_range, float law) {
    float squared = max(dot(to_light_world, to_light_world), least_distance_squared);
    return within_range(squared, inverse_range) * falloff(squared, law);
}

vec3 irradiance_of(vec3 intensity, float reach) {
    return min(intensity * reach, vec3(max_light));
}
