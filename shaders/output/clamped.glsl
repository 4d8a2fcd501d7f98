// SPDX-License-Identifier: Apache-2.0
// Radiance up to white.

#include "common/displayable.glsl"

vec3 shown(vec3 radiance) { return limited(radiance, 1.0); }
vec3 code_of(vec3 shown_radiance) { return shown_radiance; }
vec3 coded(vec3 radiance) { return shown(radiance); }
