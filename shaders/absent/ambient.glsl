// SPDX-License-Identifier: Apache-2.0
// No ambient light, or a surface that scatters none.

vec3 ambient_radiance() { return vec3(0.0); }
