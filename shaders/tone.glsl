// SPDX-License-Identifier: Apache-2.0
// Exposure and tone curves.

//@part exposure implements exposure
// Radiance times the scene's exposure.

uniform float exposure;

vec3 exposed(vec3 radiance) { return radiance * exposure; }

//@neutral exposure
vec3 exposed(vec3 radiance) { return radiance; }

//@part reinhard implements tone
// A curve that stays below 1. Source: [Reinhard et al. 2002], equation 3.

//@include "output.glsl#limited"

vec3 toned(vec3 radiance) {
    vec3 x = limited(radiance, 1e9);
    return x / (vec3(1.0) + x);
}

//@part aces implements tone
// A rational fit to the ACES reference rendering, similar to film. Source: [Narkowicz 2016].

//@include "output.glsl#limited"

vec3 toned(vec3 radiance) {
    vec3 x = limited(radiance, 1e9);
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

//@part khronos_neutral implements tone
// Keeps the colors of materials in even light, and compresses brighter ones towards white.
// Source: [Khronos PBR Neutral].

//@include "output.glsl#limited"

vec3 toned(vec3 radiance) {
    const float start = 0.8 - 0.04;  // The brightest value that is not compressed.
    const float desaturation = 0.15;
    vec3 x = limited(radiance, 1e9);
    float darkest = min(min(x.r, x.g), x.b);
    x -= darkest < 0.08 ? darkest - 6.25 * darkest * darkest : 0.04;
    float peak = max(max(x.r, x.g), x.b);
    if (peak < start) return x;
    float room = 1.0 - start;
    float compressed = 1.0 - room * room / (peak + room - start);
    float kept = 1.0 / (desaturation * (peak - compressed) + 1.0);
    return mix(vec3(compressed), x * (compressed / peak), kept);
}

//@part hill
// A fit to the ACES reference rendering and display transforms in their own color space.
// Source: [Hill 2017].

//@include "output.glsl#limited"

vec3 filmic(vec3 radiance) {
    const mat3 aces_from_srgb = mat3(0.59719, 0.07600, 0.02840,  //
                                     0.35458, 0.90834, 0.13383,  //
                                     0.04823, 0.01566, 0.83777);
    const mat3 srgb_from_aces = mat3(1.60475, -0.10208, -0.00327,  //
                                     -0.53108, 1.10813, -0.07276,  //
                                     -0.07367, -0.00605, 1.07602);
    vec3 v = aces_from_srgb * limited(radiance, 1e9);
    return srgb_from_aces * ((v * (v + 0.0245786) - 0.000090537) /
                             (v * (0.983729 * v + 0.4329510) + 0.238081));
}

//@part aces_hill implements tone
// ACES Filmic (Hill).

//@include "tone.glsl#hill"

vec3 toned(vec3 radiance) { return filmic(radiance); }

//@part aces_hill_boost implements tone
// ACES Filmic (Hill) with the exposure that other viewers of glTF put before it.

//@include "tone.glsl#hill"

vec3 toned(vec3 radiance) { return filmic(radiance * (1.0 / 0.6)); }

//@neutral tone
vec3 toned(vec3 radiance) { return radiance; }
