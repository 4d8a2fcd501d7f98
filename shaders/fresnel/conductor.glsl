// SPDX-License-Identifier: Apache-2.0
// Fresnel's equations for unpolarised light on a metal of complex index n + ik, by channel.
// Where there is no boundary (index 1, no absorption), nothing is mirrored, at grazing angles too.
// Source: [Born and Wolf 1999], 14.2.

uniform vec3 reflectivity;
uniform vec3 conductor_index;
uniform vec3 conductor_absorption;

vec3 fresnel_factor(float n_dot_v) {
    float cosine_squared = n_dot_v * n_dot_v;
    float sine_squared = 1.0 - cosine_squared;
    vec3 n_squared = conductor_index * conductor_index;
    vec3 k_squared = conductor_absorption * conductor_absorption;
    vec3 difference = n_squared - k_squared - sine_squared;
    vec3 size = sqrt(difference * difference + 4.0 * n_squared * k_squared);  // a^2 + b^2
    vec3 a = sqrt(max(0.5 * (size + difference), vec3(0.0)));
    vec3 across = (size + cosine_squared - 2.0 * a * n_dot_v) /
                  max(size + cosine_squared + 2.0 * a * n_dot_v, vec3(1e-20));
    vec3 along = (cosine_squared * size + sine_squared * sine_squared -
                  2.0 * a * n_dot_v * sine_squared) /
                 max(cosine_squared * size + sine_squared * sine_squared +
                         2.0 * a * n_dot_v * sine_squared,
                     vec3(1e-20));
    return reflectivity * (0.5 * across * (vec3(1.0) + along));
}
