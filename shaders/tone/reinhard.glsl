// SPDX-License-Identifier: Apache-2.0
// Bright light brought below white, by channel. Source: [Reinhard et al. 2002], equation 3.

#include "common/displayable.glsl"

vec3 toned(vec3 radiance) {
    vec3 x = limited(radiance, 1e9);
    return x / (vec3(1.0) + x);
}
