// SPDX-License-Identifier: Apache-2.0
// Textures and vertex colors that multiply the surface's colors. Lookups decode sRGB.

//@part tint implements tint
// The color that multiplies scattered light in Phong's model: texture and vertex color.

//@include <diffuse_texture>
//@include <vertex_color>

vec3 scattering_tint(Surface surface) { return diffuse_texel().rgb * vertex_tint().rgb; }

//@part diffuse_texture implements diffuse_texture
// The diffuse texture; its alpha is as stored.

//@include "inputs.glsl#texcoord"

uniform sampler2D diffuse_texture;

vec4 diffuse_lookup = texture(diffuse_texture, texcoord_surface);

vec4 diffuse_texel() { return diffuse_lookup; }

//@neutral diffuse_texture
vec4 diffuse_texel() { return vec4(1.0); }

//@part vertex implements vertex_color
// The interpolated vertex color and alpha: exactly white between white vertices, never negative.

in vec4 color_from_white;

vec4 vertex_tint() { return max(vec4(1.0) + color_from_white, vec4(0.0)); }

//@neutral vertex_color
vec4 vertex_tint() { return vec4(1.0); }

//@part environment_tint implements environment_tint
// The environment along the normal, which multiplies scattered light and highlights.

//@include "environment.glsl#radiance"

vec3 environment_tint(Surface surface) { return environment_radiance(surface.normal_world); }

//@neutral environment_tint
vec3 environment_tint(Surface surface) { return vec3(1.0); }

//@part specular_texture implements specular_texture
// The color of highlights.

//@include "inputs.glsl#texcoord"

uniform sampler2D specular_texture;

vec3 specular_lookup = texture(specular_texture, texcoord_surface).rgb;

vec3 specular_texture_color() { return specular_lookup; }

//@neutral specular_texture
vec3 specular_texture_color() { return vec3(1.0); }
