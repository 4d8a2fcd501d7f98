// SPDX-License-Identifier: Apache-2.0
// Phong's surfaces in an environment: what Fresnel's factor takes for the mirror image, scattering
// and refraction lose. n.v is kept within [0,1], where a bent normal may leave it. Looked up in
// world space. Source: [Blinn and Newell 1976].

#include <fresnel>
#include <mirror_image>
#include <refraction>

vec3 with_reflection(Surface surface, vec3 scattered) {
    float n_dot_v = clamp(dot(surface.normal_world, surface.view_world), 0.0, 1.0);
    vec3 fresnel = fresnel_factor(n_dot_v);
    vec3 mirrored_world = reflect(-surface.view_world, surface.normal_world);
    return with_refraction(surface, scattered) * (vec3(1.0) - fresnel) +
           mirror_image(mirrored_world) * fresnel;
}
