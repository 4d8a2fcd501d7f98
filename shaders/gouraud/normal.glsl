// SPDX-License-Identifier: Apache-2.0
// In the vertex stage the normal is what pass_normal() has just written; (0,0,1) where it has no
// length.

#include "common/normalized_or.glsl"

vec3 shading_normal() { return normalized_or(normal_world, vec3(0.0, 0.0, 1.0)); }
