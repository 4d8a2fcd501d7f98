// SPDX-License-Identifier: Apache-2.0
// A film-like curve: a rational fit to the ACES reference rendering, by channel.
// Source: [Narkowicz 2016].

#include "common/displayable.glsl"

vec3 toned(vec3 radiance) {
    vec3 x = limited(radiance, 1e9);
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}
