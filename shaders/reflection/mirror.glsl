// SPDX-License-Identifier: Apache-2.0
// The surroundings as they are.

#include "common/environment.glsl"

vec3 mirror_image(vec3 direction_world) { return environment_radiance(direction_world); }
