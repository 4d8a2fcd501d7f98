// SPDX-License-Identifier: Apache-2.0
// The vertex's colour, linear, and its coverage.

in vec4 color_linear;
out vec4 color_surface;

void pass_color() { color_surface = color_linear; }
