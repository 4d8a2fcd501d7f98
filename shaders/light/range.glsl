// SPDX-License-Identifier: Apache-2.0
// Fading to 0 at the light's range; inverse_range is 0 without one. Source: KHR_lights_punctual.

float within_range(float distance_squared, float inverse_range) {
    float squared = distance_squared * inverse_range * inverse_range;
    return clamp(1.0 - squared * squared, 0.0, 1.0);
}
