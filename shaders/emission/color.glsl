// SPDX-License-Identifier: Apache-2.0
// The surface's own light.

uniform vec3 emission_color;

vec3 emitted_radiance() { return emission_color; }
