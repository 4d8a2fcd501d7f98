// SPDX-License-Identifier: Apache-2.0
// Gouraud shading: the vertex stage computes the lights, and the fragment stage interpolates the
// result. Source: [Gouraud 1971].

//@part lights implements pass_lights
// Vertex stage: all lights at the vertex.

//@include "light.glsl#lighting"
//@include <surface>
//@include "light.glsl#all"

out vec3 lights_scattered;
out vec3 lights_highlights;

void pass_lights() {
    Lighting lighting = Lighting(vec3(0.0), vec3(0.0));
    add_lights(surface_here(), lighting);
    lights_scattered = lighting.scattered;
    lights_highlights = lighting.highlights;
}

//@part lights_both_sides implements pass_lights
// Vertex stage: all lights for both sides, since only the fragment stage knows the visible side.
// The back side has the opposite normal.

//@include "light.glsl#lighting"
//@include <surface>
//@include "light.glsl#all"

out vec3 lights_scattered;
out vec3 lights_highlights;
out vec3 lights_scattered_back;
out vec3 lights_highlights_back;

void pass_lights() {
    Surface surface = surface_here();
    Lighting front = Lighting(vec3(0.0), vec3(0.0));
    add_lights(surface, front);
    lights_scattered = front.scattered;
    lights_highlights = front.highlights;

    surface.normal_world = -surface.normal_world;
    Lighting back = Lighting(vec3(0.0), vec3(0.0));
    add_lights(surface, back);
    lights_scattered_back = back.scattered;
    lights_highlights_back = back.highlights;
}

//@neutral pass_lights
void pass_lights() {}

//@part normal implements normal
// Vertex stage: the normal that pass_normal() has just written; (0,0,1) if it is zero.

//@include "vector.glsl#normalized_or"

vec3 shading_normal() { return normalized_or(normal_world, vec3(0.0, 0.0, 1.0)); }

//@part interpolated implements lights
// Fragment stage: the interpolated light.

in vec3 lights_scattered;
in vec3 lights_highlights;

void add_lights(Surface surface, inout Lighting lighting) {
    lighting.scattered += lights_scattered;
    lighting.highlights += lights_highlights;
}

//@part interpolated_both_sides implements lights
// Fragment stage: the interpolated light of the visible side.

in vec3 lights_scattered;
in vec3 lights_highlights;
in vec3 lights_scattered_back;
in vec3 lights_highlights_back;

void add_lights(Surface surface, inout Lighting lighting) {
    lighting.scattered += gl_FrontFacing ? lights_scattered : lights_scattered_back;
    lighting.highlights += gl_FrontFacing ? lights_highlights : lights_highlights_back;
}
