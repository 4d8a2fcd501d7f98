// SPDX-License-Identifier: Apache-2.0
// Radiance without what no picture can hold: NaN and negative values become 0, infinite ones the
// limit. Here a NaN that came in with a vertex or a texel ends.

vec3 limited(vec3 radiance, float limit) {
    return mix(vec3(0.0), min(radiance, vec3(limit)), greaterThan(radiance, vec3(0.0)));
}
