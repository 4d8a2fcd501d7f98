// SPDX-License-Identifier: Apache-2.0
// Diffuse scattering, the same to every side. Source: [Lambert 1760].

#include "common/diffuse_color.glsl"

vec3 diffuse_scattering(float n_dot_l) { return diffuse_color * n_dot_l; }
