// SPDX-License-Identifier: Apache-2.0
// Each point has its own colour.

in vec4 color_linear;
out vec3 overlay_color;

void pass_overlay_color() { overlay_color = color_linear.rgb; }
