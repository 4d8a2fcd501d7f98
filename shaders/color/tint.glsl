// SPDX-License-Identifier: Apache-2.0
// What multiplies scattered light: texture and vertex colour.

#include <diffuse_texture>
#include <vertex_color>

vec3 scattering_tint(Surface surface) { return diffuse_texel().rgb * vertex_tint().rgb; }
