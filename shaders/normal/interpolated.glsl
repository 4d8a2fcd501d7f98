// SPDX-License-Identifier: Apache-2.0
// The interpolated normal, made unit again; (0,0,1) where it has no length.

#include "common/normalized_or.glsl"
#include <facing>

in vec3 normal_world;

vec3 shading_normal() { return facing() * normalized_or(normal_world, vec3(0.0, 0.0, 1.0)); }
