// SPDX-License-Identifier: Apache-2.0
// What lamps did at the vertices to the side that is seen, interpolated.

in vec3 lamps_scattered;
in vec3 lamps_highlights;
in vec3 lamps_scattered_back;
in vec3 lamps_highlights_back;

void add_lamps(Surface surface, inout Lighting lighting) {
    lighting.scattered += gl_FrontFacing ? lamps_scattered : lamps_scattered_back;
    lighting.highlights += gl_FrontFacing ? lamps_highlights : lamps_highlights_back;
}
