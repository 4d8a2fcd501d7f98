// SPDX-License-Identifier: Apache-2.0
// Texture coordinates: (0,0) is the image's upper left corner, v grows downwards.

in vec2 texcoord;
out vec2 texcoord_surface;

void pass_texcoord() { texcoord_surface = texcoord; }
