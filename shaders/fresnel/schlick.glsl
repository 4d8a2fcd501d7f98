// SPDX-License-Identifier: Apache-2.0
// From reflectivity head on to grazing_reflectivity. Source: [Schlick 1994].

uniform vec3 reflectivity;
uniform vec3 grazing_reflectivity;

vec3 fresnel_factor(float n_dot_v) {
    float m = 1.0 - n_dot_v;
    return reflectivity + (grazing_reflectivity - reflectivity) * (m * m * m * m * m);
}
