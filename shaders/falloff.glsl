// SPDX-License-Identifier: Apache-2.0
// Direction and irradiance of point and spot lights, by distance.

//@part irradiance
// A light at distance 0 has no direction and contributes nothing. Near ones give max_light at most,
// so that every product with it stays finite.

//@include <distance_law>
//@include <range>

const float min_distance_squared = 1e-36;
const float max_light = 1e18;

vec3 direction_to(vec3 to_light_world) {
    float squared = dot(to_light_world, to_light_world);
    return to_light_world * inversesqrt(max(squared, min_distance_squared));
}

// The share of a light's intensity that arrives at this distance.
float reach_of(vec3 to_light_world, float inverse_range, float law) {
    float squared = max(dot(to_light_world, to_light_world), min_distance_squared);
    return within_range(squared, inverse_range) * falloff(squared, law);
}

vec3 irradiance_of(vec3 intensity, float reach) {
    return min(intensity * reach, vec3(max_light));
}

//@part inverse_square implements distance_law
// All lights follow the inverse-square law.

float falloff(float distance_squared, float law) { return 1.0 / distance_squared; }

//@part none implements distance_law
// No light falls off with distance.

float falloff(float distance_squared, float law) { return 1.0; }

//@part mixed implements distance_law
// The inverse-square law if law is 1, and none if it is 0.

float falloff(float distance_squared, float law) {
    return 1.0 / (law * distance_squared + (1.0 - law));
}

//@part range implements range
// Fades to 0 at the light's range; inverse_range is 0 without one. Source: KHR_lights_punctual.

float within_range(float distance_squared, float inverse_range) {
    float squared = distance_squared * inverse_range * inverse_range;
    return clamp(1.0 - squared * squared, 0.0, 1.0);
}

//@neutral range
float within_range(float distance_squared, float inverse_range) { return 1.0; }
