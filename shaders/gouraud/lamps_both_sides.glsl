// SPDX-License-Identifier: Apache-2.0
// Lamps at the vertex for both sides, of which the fragment picks the one it sees: the back has
// the opposite normal. Source: [Gouraud 1971].

#include "light/lighting.glsl"
#include <surface>
#include "light/lamps.glsl"

out vec3 lamps_scattered;
out vec3 lamps_highlights;
out vec3 lamps_scattered_back;
out vec3 lamps_highlights_back;

void pass_lamps() {
    Surface surface = surface_here();
    Lighting front = Lighting(vec3(0.0), vec3(0.0));
    add_lamps(surface, front);
    lamps_scattered = front.scattered;
    lamps_highlights = front.highlights;

    surface.normal_world = -surface.normal_world;
    Lighting back = Lighting(vec3(0.0), vec3(0.0));
    add_lamps(surface, back);
    lamps_scattered_back = back.scattered;
    lamps_highlights_back = back.highlights;
}
