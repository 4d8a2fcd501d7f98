// SPDX-License-Identifier: Apache-2.0
// The same reflectivity at every angle.

uniform vec3 reflectivity;

vec3 fresnel_factor(float n_dot_v) { return reflectivity; }
