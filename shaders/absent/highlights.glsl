// SPDX-License-Identifier: Apache-2.0
// A view of what is scattered alone: no highlights.

vec3 specular_texture_color() { return vec3(0.0); }
