// SPDX-License-Identifier: Apache-2.0
// Radiance, exposed and tone-mapped, up to white, as sRGB codes. Source: [IEC 61966-2-1].

#include "common/displayable.glsl"
#include <exposure>
#include <tone>

vec3 shown(vec3 radiance) { return limited(toned(exposed(radiance)), 1.0); }

vec3 code_of(vec3 shown_radiance) {
    vec3 curved = 1.055 * pow(max(shown_radiance, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
    return mix(curved, 12.92 * shown_radiance, lessThanEqual(shown_radiance, vec3(0.0031308)));
}

vec3 coded(vec3 radiance) { return code_of(shown(radiance)); }
