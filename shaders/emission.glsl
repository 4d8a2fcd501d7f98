// SPDX-License-Identifier: Apache-2.0
// The light that the surface emits.

//@part color implements emission
// One color.

//@include <term_limit>

uniform vec3 emission_color;

vec3 emitted_radiance() { return limited(emission_color); }

//@part texture implements emission
// A color times a texture; the lookup decodes sRGB.

//@include "inputs.glsl#texcoord"
//@include <term_limit>

uniform vec3 emission_color;
uniform sampler2D emission_texture;

vec3 emission_lookup = texture(emission_texture, texcoord_surface).rgb;

vec3 emitted_radiance() { return limited(emission_color) * emission_lookup; }

//@neutral emission
vec3 emitted_radiance() { return vec3(0.0); }
