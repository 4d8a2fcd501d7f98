// SPDX-License-Identifier: Apache-2.0
// The share of light that the surface scatters.

uniform vec3 diffuse_color;
