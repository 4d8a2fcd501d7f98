// SPDX-License-Identifier: Apache-2.0
// The same colour everywhere.

out vec3 overlay_color;

uniform vec3 all_color;

void pass_overlay_color() { overlay_color = all_color; }
