// SPDX-License-Identifier: Apache-2.0
// Highlights have one colour.

vec3 specular_texture_color() { return vec3(1.0); }
