// SPDX-License-Identifier: Apache-2.0
// The surroundings behind everything.

in vec3 direction_world;
out vec4 color;

#include "common/environment.glsl"

#include <output>

void main() {
    vec3 radiance = environment_radiance(direction_world);
    color = vec4(coded(radiance), 1.0);
}
