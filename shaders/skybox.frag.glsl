// SPDX-License-Identifier: Apache-2.0
// The surroundings behind everything.

in vec3 direction_world;
out vec4 color;

uniform samplerCube environment;
uniform float environment_intensity;

#include <output>

void main() {
    vec3 radiance = texture(environment, direction_world).rgb * environment_intensity;
    color = vec4(coded(radiance), 1.0);
}
