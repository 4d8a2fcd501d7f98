// SPDX-License-Identifier: Apache-2.0
// Fresnel's equations for unpolarised light that enters a denser, clear medium.
// Where there is no boundary (index 1), nothing is mirrored, at grazing angles too.
// Source: [Born and Wolf 1999], 1.5.2.

uniform vec3 reflectivity;
uniform float refractive_index;

vec3 fresnel_factor(float n_dot_v) {
    float index_squared = refractive_index * refractive_index;
    // The index times the cosine inside, by Snell's law: exactly n.v where nothing is refracted.
    float inside = sqrt(index_squared - 1.0 + n_dot_v * n_dot_v);
    float across = (n_dot_v - inside) / max(n_dot_v + inside, 1e-20);
    float along =
        (index_squared * n_dot_v - inside) / max(index_squared * n_dot_v + inside, 1e-20);
    return reflectivity * (0.5 * (across * across + along * along));
}
