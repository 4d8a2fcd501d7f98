// SPDX-License-Identifier: Apache-2.0
// Radiance up to white, as sRGB codes. Source: IEC 61966-2-1.

#include "common/displayable.glsl"

vec3 coded(vec3 radiance) {
    vec3 shown = limited(radiance, 1.0);
    vec3 curved = 1.055 * pow(max(shown, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
    return mix(curved, 12.92 * shown, lessThanEqual(shown, vec3(0.0031308)));
}
