// SPDX-License-Identifier: Apache-2.0
// Opacity by texture: its red.

#include "common/texcoord.glsl"

uniform sampler2D opacity_texture;

float opacity_texel() { return texture(opacity_texture, texcoord_surface).r; }
