// SPDX-License-Identifier: Apache-2.0
// The environment map and the light that surfaces scatter from it. Directions are in world space.

//@part intensity
// The factor of the environment's radiance.

uniform float environment_intensity;

//@part rotation implements environment_rotation
// Rotates a direction about the y axis, against the rotation of the environment.

uniform vec2 environment_turn;  // The cosine and the sine.

vec3 direction_in_map(vec3 direction_world) {
    vec2 xz = direction_world.xz;
    return vec3(environment_turn.x * xz.x - environment_turn.y * xz.y, direction_world.y,
                environment_turn.y * xz.x + environment_turn.x * xz.y);
}

//@neutral environment_rotation
vec3 direction_in_map(vec3 direction_world) { return direction_world; }

//@part radiance
// The radiance from a direction.

//@include "environment.glsl#intensity"
//@include <environment_rotation>

uniform samplerCube environment;

vec3 environment_radiance(vec3 direction_world) {
    return texture(environment, direction_in_map(direction_world)).rgb * environment_intensity;
}

//@part blurred
// The radiance around a direction, blurred by the GGX lobe of a roughness: each level of the map is
// prefiltered for one roughness, evenly spaced. Source: [Karis, SIGGRAPH 2013].

//@include "environment.glsl#intensity"
//@include <environment_rotation>

uniform samplerCube blurred_environment;
uniform float blurred_levels;  // The last level's number, which stands for roughness 1.

vec3 blurred_radiance(vec3 direction_world, float roughness) {
    return textureLod(blurred_environment, direction_in_map(direction_world),
                      roughness * blurred_levels)
               .rgb *
           environment_intensity;
}

//@part brdf_table
// GGX's directional albedo at n.v and a roughness: the factors of f0 and f90, from a table over
// sqrt(n.v) and roughness. Source: [Karis, SIGGRAPH 2013].

uniform sampler2D environment_brdf;

vec2 albedo_factors(float n_dot_v, float roughness) {
    // From the center of the first texel to that of the last.
    vec2 size = vec2(textureSize(environment_brdf, 0));
    vec2 place = (vec2(sqrt(n_dot_v), roughness) * (size - 1.0) + 0.5) / size;
    return textureLod(environment_brdf, place, 0.0).rg;
}

//@part brdf
// The share of the environment's light that glTF's facets mirror, and the share that scattering
// lacks.

//@include "environment.glsl#brdf_table"
//@include <grazing>
//@include <film>
//@include <scattering_bounces>

vec3 mirrored_albedo(Surface surface) {
    float n_dot_v = clamp(dot(surface.normal_world, surface.view_world), 0.0, 1.0);
    vec2 factors = albedo_factors(n_dot_v, surface.roughness);
    return with_film(surface, n_dot_v, factors.x + factors.y,
                     surface.f0 * factors.x + grazing_reflectance(surface) * factors.y);
}

vec3 blocked_albedo(Surface surface) {
    float n_dot_v = clamp(dot(surface.normal_world, surface.view_world), 0.0, 1.0);
    vec2 factors = albedo_factors(n_dot_v, surface.roughness);
    vec3 blocked = blocked_by_film(
        surface, n_dot_v, factors.x + factors.y,
        blocking_f0(surface) * factors.x + grazing_reflectance(surface) * factors.y);
    return with_blocked_bounces(surface, n_dot_v, factors, blocked);
}

//@part irradiance
// The environment's irradiance on a surface with normal n, over pi, by spherical harmonics of
// order 2: its projection onto nine functions of the direction, already convolved with the cosine
// lobe and multiplied by their constants. Source: [Ramamoorthi and Hanrahan 2001].

uniform vec4 irradiance_sh[9];

vec3 environment_irradiance(vec3 n) {
    vec3 sum = irradiance_sh[0].rgb + irradiance_sh[1].rgb * n.y + irradiance_sh[2].rgb * n.z +
               irradiance_sh[3].rgb * n.x + irradiance_sh[4].rgb * (n.x * n.y) +
               irradiance_sh[5].rgb * (n.y * n.z) +
               irradiance_sh[6].rgb * (3.0 * n.z * n.z - 1.0) +
               irradiance_sh[7].rgb * (n.x * n.z) +
               irradiance_sh[8].rgb * (n.x * n.x - n.y * n.y);
    return max(sum, vec3(0.0));
}

//@part light_phong implements environment_light
// Phong's model scatters the environment's light.

//@include "inputs.glsl#diffuse_color"
//@include "environment.glsl#irradiance"
//@include <occlusion>
//@include <term_limit>

void add_environment_light(Surface surface, inout Lighting lighting) {
    vec3 received = environment_irradiance(surface.normal_world);
    lighting.scattered += limited(diffuse_color * received) * occlusion();
}

//@part light_metallic_roughness implements environment_light
// glTF's model scatters the share that it does not mirror.

//@include "environment.glsl#brdf"
//@include "environment.glsl#irradiance"
//@include <occlusion>

void add_environment_light(Surface surface, inout Lighting lighting) {
    vec3 received = environment_irradiance(surface.normal_world) * occlusion();
    lighting.scattered += received * (vec3(1.0) - blocked_albedo(surface));
}

//@neutral environment_light
void add_environment_light(Surface surface, inout Lighting lighting) {}
