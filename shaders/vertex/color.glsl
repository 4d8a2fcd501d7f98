// SPDX-License-Identifier: Apache-2.0
// The vertex's colour, linear.

in vec4 color_linear;
out vec3 color_surface;

void pass_color() { color_surface = color_linear.rgb; }
