// SPDX-License-Identifier: Apache-2.0
// Fresnel's equations for unpolarised light that enters a denser, clear medium.
// Source: [Born and Wolf 1999], 1.5.2.

uniform vec3 reflectivity;
uniform float refractive_index;

vec3 fresnel_factor(float n_dot_v) {
    float inside = sqrt(max(1.0 - (1.0 - n_dot_v * n_dot_v) / (refractive_index * refractive_index),
                            0.0));
    float across = (n_dot_v - refractive_index * inside) / (n_dot_v + refractive_index * inside);
    float along = (refractive_index * n_dot_v - inside) / (refractive_index * n_dot_v + inside);
    return reflectivity * (0.5 * (across * across + along * along));
}
