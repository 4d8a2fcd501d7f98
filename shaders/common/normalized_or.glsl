// SPDX-License-Identifier: Apache-2.0
// A vector as a unit vector, or the fallback where it has no length that a float can square, or is
// not finite: NaN fails both comparisons.

vec3 normalized_or(vec3 v, vec3 fallback) {
    float squared = dot(v, v);
    return squared > 1e-30 && squared < 1e30 ? v * inversesqrt(squared) : fallback;
}
