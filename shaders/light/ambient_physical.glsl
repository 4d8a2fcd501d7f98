// SPDX-License-Identifier: Apache-2.0
// Light from everywhere, of which a surface shows what it scatters and what it mirrors.

#include <occlusion>

uniform vec3 ambient_scattered;

void add_ambient(Surface surface, inout Lighting lighting) {
    vec3 received = ambient_scattered * occlusion();
    lighting.scattered += received;
    lighting.highlights += received * surface.f0;
}
