// SPDX-License-Identifier: Apache-2.0
// Radiance as far as a half float goes, for a pass that finishes the picture.

#include "common/displayable.glsl"

vec3 shown(vec3 radiance) { return limited(radiance, 65504.0); }
vec3 code_of(vec3 shown_radiance) { return shown_radiance; }
vec3 coded(vec3 radiance) { return shown(radiance); }
