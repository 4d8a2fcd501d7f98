// SPDX-License-Identifier: Apache-2.0
// The interpolated vertex colour.

in vec3 color_surface;

vec3 vertex_tint() { return color_surface; }
