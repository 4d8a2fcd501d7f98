// SPDX-License-Identifier: Apache-2.0
// The surroundings, mirrored about the normal and looked up in world space; what they take by
// Schlick's Fresnel term, scattering loses. n.v is kept within [0,1], where a bent normal may leave
// it. Source: [Blinn and Newell 1976], [Schlick 1994].

uniform samplerCube environment;
uniform float environment_intensity;
uniform vec3 reflectivity;
uniform vec3 grazing_reflectivity;

vec3 with_reflection(Surface surface, vec3 scattered) {
    float n_dot_v = clamp(dot(surface.normal_world, surface.view_world), 0.0, 1.0);
    float m = 1.0 - n_dot_v;
    vec3 fresnel = reflectivity + (grazing_reflectivity - reflectivity) * (m * m * m * m * m);
    vec3 mirrored_world = reflect(-surface.view_world, surface.normal_world);
    vec3 mirrored = texture(environment, mirrored_world).rgb * environment_intensity;
    return scattered * (vec3(1.0) - fresnel) + mirrored * fresnel;
}
