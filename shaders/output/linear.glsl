// SPDX-License-Identifier: Apache-2.0
// Radiance as it is, as far as a float goes.

#include "common/displayable.glsl"

vec3 shown(vec3 radiance) { return limited(radiance, 3e38); }
vec3 code_of(vec3 shown_radiance) { return shown_radiance; }
vec3 coded(vec3 radiance) { return shown(radiance); }
