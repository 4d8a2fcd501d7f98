// SPDX-License-Identifier: Apache-2.0
// A vector at a length whose square a float holds: its largest component is 1. One without length
// stays as it is.

float rescaling(vec3 v) {
    float largest = max(max(abs(v.x), abs(v.y)), abs(v.z));
    return largest > 0.0 ? 1.0 / largest : 1.0;
}

vec3 rescaled(vec3 v) { return v * rescaling(v); }
