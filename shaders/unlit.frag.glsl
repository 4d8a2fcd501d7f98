// SPDX-License-Identifier: Apache-2.0
// A surface without any light: its diffuse colour is the picture.

out vec4 color;

uniform vec3 diffuse_color;

#include <diffuse_texture>
#include <vertex_color>
#include <output>

void main() { color = vec4(coded(diffuse_color * diffuse_texture_color() * vertex_tint()), 1.0); }
