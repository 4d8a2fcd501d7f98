// SPDX-License-Identifier: Apache-2.0
// The normal in tangent space, from a map.

#include "detail/normal_texel.glsl"

vec3 normal_tangent() { return normal_texel(); }
