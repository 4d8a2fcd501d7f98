// SPDX-License-Identifier: Apache-2.0
// The interpolated vertex colour, and how much the surface covers there.

in vec4 color_surface;

vec4 vertex_tint() { return color_surface; }
