// SPDX-License-Identifier: Apache-2.0
// Radiance times the scene's exposure.

uniform float exposure;

vec3 exposed(vec3 radiance) { return radiance * exposure; }
