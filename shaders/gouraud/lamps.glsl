// SPDX-License-Identifier: Apache-2.0
// Lamps at the vertex, interpolated as colours. Source: [Gouraud 1971].

#include "light/lighting.glsl"
#include <surface>
#include "light/lamps.glsl"

out vec3 lamps_scattered;
out vec3 lamps_highlights;

void pass_lamps() {
    Lighting lighting = Lighting(vec3(0.0), vec3(0.0));
    add_lamps(surface_here(), lighting);
    lamps_scattered = lighting.scattered;
    lamps_highlights = lighting.highlights;
}
