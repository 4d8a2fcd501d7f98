// SPDX-License-Identifier: Apache-2.0
// Highlights on minified normal maps.

//@part toksvig implements sharpness
// Widens highlights by the variance of a minified normal map within a pixel. Averaged unit vectors
// are shorter the more they differ: 1 / length - 1 is their variance, and an exponent s becomes
// s / (1 + s * variance), dimmed so that the highlight keeps its energy. The loss of length by the
// rounding of the map's codes does not count. Source: [Toksvig 2005].

//@include "normal_map.glsl#texel"

uniform vec3 normal_map_unscale;    // Back to the stored vector: 1, or 1 / scale in x and y.
uniform float normal_map_rounding;  // The largest error of a coded unit vector's length.

float normal_variance() {
    float stored = length(normal_texel() * normal_map_unscale);
    return max(1.0 / max(stored, 1e-3) - 1.0 - normal_map_rounding, 0.0);
}

float sharpened(float exponent) {
    float variance = normal_variance();
    return variance > 0.0 ? exponent / (1.0 + exponent * variance) : exponent;
}

float dimmed(float exponent) {
    float variance = normal_variance();
    return variance > 0.0 ? (1.0 + sharpened(exponent)) / (1.0 + exponent) : 1.0;
}

// The same for GGX, whose alpha squared corresponds to the exponent 2 / alpha squared - 2.
float widened(float roughness) {
    float variance = normal_variance();
    if (!(variance > 0.0)) return roughness;
    float alpha_squared = roughness * roughness * roughness * roughness;
    float exponent = sharpened(2.0 / alpha_squared - 2.0);
    return min(sqrt(sqrt(2.0 / (exponent + 2.0))), 1.0);
}

//@neutral sharpness
float sharpened(float exponent) { return exponent; }
float dimmed(float exponent) { return 1.0; }
float widened(float roughness) { return roughness; }
