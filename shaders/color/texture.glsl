// SPDX-License-Identifier: Apache-2.0
// The diffuse texture, decoded from sRGB by the lookup.

#include "common/texcoord.glsl"

uniform sampler2D diffuse_texture;

vec3 diffuse_texture_color() { return texture(diffuse_texture, texcoord_surface).rgb; }
