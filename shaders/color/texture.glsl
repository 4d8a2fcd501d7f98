// SPDX-License-Identifier: Apache-2.0
// The diffuse texture, decoded from sRGB by the lookup; its alpha is as stored.

#include "common/texcoord.glsl"

uniform sampler2D diffuse_texture;

vec4 diffuse_texel() { return texture(diffuse_texture, texcoord_surface); }
