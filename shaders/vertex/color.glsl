// SPDX-License-Identifier: Apache-2.0
// The vertex's colour, linear, and its coverage, as their distance from white: a rasteriser
// interpolates 0 exactly, but 1 as 1 - 6e-8, which would let a mask with cutoff 1 cut holes.

in vec4 color_linear;
out vec4 color_from_white;

void pass_color() { color_from_white = color_linear - vec4(1.0); }
