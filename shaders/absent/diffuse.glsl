// SPDX-License-Identifier: Apache-2.0
// The surface scatters no light.

vec3 diffuse_scattering(float n_dot_l) { return vec3(0.0); }
