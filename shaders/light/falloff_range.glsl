// SPDX-License-Identifier: Apache-2.0
// The inverse square law, fading to 0 at the light's range; inverse_range is 0 without one.
// Source: KHR_lights_punctual.

float falloff(float distance_squared, float inverse_range) {
    float squared = distance_squared * inverse_range * inverse_range;
    return clamp(1.0 - squared * squared, 0.0, 1.0) / distance_squared;
}
