// SPDX-License-Identifier: Apache-2.0
// Fresnel's factor: the share of light that a surface mirrors, by angle and channel.

//@part viewing_cosine
// n.v, clamped to [0,1], since a perturbed normal may leave it.

float viewing_cosine(Surface surface) {
    return clamp(dot(surface.normal_world, surface.view_world), 0.0, 1.0);
}

//@part constant implements fresnel
// The same reflectivity at every angle.

uniform vec3 reflectivity;

vec3 fresnel_factor(Surface surface) { return reflectivity; }

//@part schlick implements fresnel
// Schlick's approximation: from reflectivity at normal incidence to grazing_reflectivity.
// Source: [Schlick 1994].

//@include "fresnel.glsl#viewing_cosine"

uniform vec3 reflectivity;
uniform vec3 grazing_reflectivity;

vec3 fresnel_factor(Surface surface) {
    float n_dot_v = viewing_cosine(surface);
    float m = 1.0 - n_dot_v;
    return reflectivity + (grazing_reflectivity - reflectivity) * (m * m * m * m * m);
}

//@part dielectric implements fresnel
// Fresnel's equations for unpolarized light that enters a denser, clear medium. With index 1 there
// is no boundary, and nothing is mirrored, at grazing angles too. Source: [Born and Wolf 1999],
// 1.5.2.

//@include "fresnel.glsl#viewing_cosine"

uniform vec3 reflectivity;
uniform float refractive_index;

vec3 fresnel_factor(Surface surface) {
    float n_dot_v = viewing_cosine(surface);
    float index_squared = refractive_index * refractive_index;
    // The index times the cosine inside, by Snell's law: exactly n.v where nothing is refracted.
    float inside = sqrt(index_squared - 1.0 + n_dot_v * n_dot_v);
    float across = (n_dot_v - inside) / max(n_dot_v + inside, 1e-20);
    float along =
        (index_squared * n_dot_v - inside) / max(index_squared * n_dot_v + inside, 1e-20);
    return reflectivity * (0.5 * (across * across + along * along));
}

//@part conductor implements fresnel
// Fresnel's equations for unpolarized light on a metal of complex index n + ik, by channel. With
// index 1 and no absorption there is no boundary, and nothing is mirrored, at grazing angles too.
// Source: [Born and Wolf 1999], 14.2.

//@include "fresnel.glsl#viewing_cosine"

uniform vec3 reflectivity;
uniform vec3 conductor_index;
uniform vec3 conductor_absorption;

vec3 fresnel_factor(Surface surface) {
    float n_dot_v = viewing_cosine(surface);
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
