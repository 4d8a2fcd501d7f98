// SPDX-License-Identifier: Apache-2.0
// What lamps did at the vertices, interpolated.

in vec3 lamps_scattered;
in vec3 lamps_highlights;

void add_lamps(Surface surface, inout Lighting lighting) {
    lighting.scattered += lamps_scattered;
    lighting.highlights += lamps_highlights;
}
