// SPDX-License-Identifier: Apache-2.0
// A vector as a unit vector, or the fallback where it has no length that a float can square, or is
// not finite: NaN fails both comparisons.

bool has_direction(vec3 v) {
    float squared = dot(v, v);
    return squared > 1e-30 && squared < 1e30;
}

vec3 normalized_or(vec3 v, vec3 fallback) {
    return has_direction(v) ? v * inversesqrt(dot(v, v)) : fallback;
}
