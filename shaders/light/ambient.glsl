// SPDX-License-Identifier: Apache-2.0
// Light from everywhere, scattered: the material's share of the scene's.

#include <occlusion>

uniform vec3 ambient_scattered;

void add_ambient(Surface surface, inout Lighting lighting) {
    lighting.scattered += ambient_scattered * occlusion();
}
