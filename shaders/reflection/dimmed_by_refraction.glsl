// SPDX-License-Identifier: Apache-2.0
// A view of what transmission dims: nothing is seen through the surface.

uniform float transmission;

vec3 with_refraction(Surface surface, vec3 scattered) { return scattered * (1.0 - transmission); }
