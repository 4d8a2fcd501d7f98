// SPDX-License-Identifier: Apache-2.0
// The light that bounces between the facets of glTF's surfaces and of their clear coat. A single
// bounce loses the share 1 - A - B, with A and B of environment.glsl#brdf_table; it is 0.69 for
// roughness 1 at normal incidence.

//@part weight
// 1 if the material keeps that light, else 0.

uniform float energy_compensation;

//@part highlights implements highlight_gain
// The factor of the light that facets mirror from light sources. Source: [Turquin 2019].

//@include "energy_compensation.glsl#weight"
//@include <lobe_albedo>
//@include <film>

vec3 highlight_gain(Surface surface) {
    float n_dot_v = clamp(dot(surface.normal_world, surface.view_world), 0.0, 1.0);
    vec2 factors = lobe_albedo(surface, n_dot_v);
    vec3 f0 = min(with_film(surface, n_dot_v, 1.0, surface.f0), vec3(1.0));
    return vec3(1.0) + f0 * (energy_compensation * (1.0 / (factors.x + factors.y) - 1.0));
}

//@neutral highlight_gain
vec3 highlight_gain(Surface surface) { return vec3(1.0); }

//@part lobe_albedo implements lobe_albedo
// The albedo of facets that are as rough in all directions.

//@include "environment.glsl#brdf_table"

vec2 lobe_albedo(Surface surface, float n_dot_v) {
    return albedo_factors(n_dot_v, surface.roughness);
}

//@part coat_highlights implements clearcoat_gain
// The factor of the coat's highlights. The coat's weight is outside, so its facets mirror all light.

//@include "energy_compensation.glsl#weight"
//@include "clearcoat.glsl#roughness"
//@include "environment.glsl#brdf_table"
//@include <clearcoat_normal>

float clearcoat_gain(Surface surface) {
    float n_dot_v = clamp(dot(clearcoat_normal(surface), surface.view_world), 0.0, 1.0);
    vec2 factors = albedo_factors(n_dot_v, coat_roughness());
    return 1.0 + energy_compensation * (1.0 / (factors.x + factors.y) - 1.0);
}

//@neutral clearcoat_gain
float clearcoat_gain(Surface surface) { return 1.0; }

//@part coat_reflection implements clearcoat_bounces
// The light of the environment that the coat's first bounce loses.

//@include "energy_compensation.glsl#weight"
//@include "environment.glsl#blurred"

vec3 clearcoat_bounces(vec3 normal, float mirrored) {
    return blurred_radiance(normal, 1.0) * (energy_compensation * (1.0 - mirrored));
}

//@neutral clearcoat_bounces
vec3 clearcoat_bounces(vec3 normal, float mirrored) { return vec3(0.0); }

//@part share
// The share of even light that facets mirror after the first bounce, from the share that they mirror
// at once and the mean of Fresnel's factor. Source: [Fdez-Aguera 2019], equations 13 to 18.

//@include "energy_compensation.glsl#weight"

vec3 bounced_share(vec2 factors, vec3 mirrored, vec3 mean_fresnel) {
    float lost = 1.0 - (factors.x + factors.y);
    return mirrored * mean_fresnel * ((energy_compensation * lost) / (vec3(1.0) - lost * mean_fresnel));
}

// The mean of Schlick's factor over the hemisphere.
vec3 mean_schlick(vec3 f0, vec3 f90) { return f0 + (f90 - f0) * (1.0 / 21.0); }

//@part scattering implements scattering_bounces
// Scattered light lacks the light of all bounces.

//@include "energy_compensation.glsl#share"
//@include <film>
//@include <grazing>

vec3 with_blocked_bounces(Surface surface, float n_dot_v, vec2 factors, vec3 blocked) {
    vec3 mean = mean_schlick(blocking_f0(surface), grazing_reflectance(surface));
    vec3 mean_fresnel = min(blocked_by_film(surface, n_dot_v, 1.0, mean), vec3(1.0));
    return blocked + bounced_share(factors, blocked, mean_fresnel);
}

//@neutral scattering_bounces
vec3 with_blocked_bounces(Surface surface, float n_dot_v, vec2 factors, vec3 blocked) {
    return blocked;
}

//@part reflection implements bounced_light
// The bounced light of the environment has no direction: it is that of roughness 1 about the normal.

//@include "energy_compensation.glsl#share"
//@include "environment.glsl#blurred"
//@include "environment.glsl#brdf_table"
//@include <film>
//@include <grazing>
//@include <occlusion>

vec3 with_bounced_light(Surface surface, vec3 mirrored, vec3 radiance) {
    float n_dot_v = clamp(dot(surface.normal_world, surface.view_world), 0.0, 1.0);
    vec3 mean = mean_schlick(surface.f0, grazing_reflectance(surface));
    vec3 mean_fresnel = min(with_film(surface, n_dot_v, 1.0, mean), vec3(1.0));
    vec3 share =
        bounced_share(albedo_factors(n_dot_v, surface.roughness), mirrored, mean_fresnel);
    return radiance + blurred_radiance(surface.normal_world, 1.0) * occlusion() * share;
}

//@neutral bounced_light
vec3 with_bounced_light(Surface surface, vec3 mirrored, vec3 radiance) { return radiance; }
