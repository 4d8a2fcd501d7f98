// SPDX-License-Identifier: Apache-2.0
// Light from everywhere, scattered: the material's share of the scene's.

uniform vec3 ambient_scattered;

vec3 ambient_radiance() { return ambient_scattered; }
