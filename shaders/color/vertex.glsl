// SPDX-License-Identifier: Apache-2.0
// The interpolated vertex colour, and how much the surface covers there: exactly white between white
// vertices, and never below black.

in vec4 color_from_white;

vec4 vertex_tint() { return max(vec4(1.0) + color_from_white, vec4(0.0)); }
