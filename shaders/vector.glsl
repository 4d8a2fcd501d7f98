// SPDX-License-Identifier: Apache-2.0
// Vectors whose length is zero, or too large or too small to square.

//@part normalized_or
// Returns the unit vector, or the fallback if the squared length is outside a float's range or the
// vector is not finite: NaN fails both comparisons.

bool has_direction(vec3 v) {
    float squared = dot(v, v);
    return squared > 1e-30 && squared < 1e30;
}

vec3 normalized_or(vec3 v, vec3 fallback) {
    return has_direction(v) ? v * inversesqrt(dot(v, v)) : fallback;
}

//@part rescaled
// Scales a vector so that its largest component is 1 and its square fits a float. The zero vector
// stays as it is.

float rescaling(vec3 v) {
    float largest = max(max(abs(v.x), abs(v.y)), abs(v.z));
    return largest > 0.0 ? 1.0 / largest : 1.0;
}

vec3 rescaled(vec3 v) { return v * rescaling(v); }
