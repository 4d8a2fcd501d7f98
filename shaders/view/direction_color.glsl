// SPDX-License-Identifier: Apache-2.0
// A unit vector as a colour; one without length, or not finite, is mid-grey.

#include "common/normalized_or.glsl"

vec3 direction_color(vec3 direction) {
    return 0.5 * normalized_or(direction, vec3(0.0)) + vec3(0.5);
}
