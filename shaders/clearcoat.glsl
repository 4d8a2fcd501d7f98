// SPDX-License-Identifier: Apache-2.0
// A clear layer on top of glTF's surfaces, which dims what is below by its own reflection. Only a
// normal map of its own bends it. Source: KHR_materials_clearcoat.

//@part layer implements clearcoat
// The coat over the radiance of the surface, emission included. Its weight is Schlick's Fresnel
// factor of the index 1.5 at n.v.

//@include <clearcoat_normal>
//@include <clearcoat_lights>
//@include <clearcoat_gain>
//@include <clearcoat_ambient>
//@include <clearcoat_reflection>
//@include <clearcoat_texture>

uniform float clearcoat;

vec3 with_clearcoat(Surface surface, vec3 radiance) {
    float m = 1.0 - clamp(dot(clearcoat_normal(surface), surface.view_world), 0.0, 1.0);
    float weight = clearcoat * clearcoat_texel() * (0.04 + 0.96 * (m * m * m * m * m));
    vec3 coat = clearcoat_from_lights() * clearcoat_gain(surface) + clearcoat_from_ambient() +
                clearcoat_reflection(surface);
    return radiance * (1.0 - weight) + coat * weight;
}

//@neutral clearcoat
vec3 with_clearcoat(Surface surface, vec3 radiance) { return radiance; }

//@part normal implements clearcoat_normal
// The normal without the map.

//@include "inputs.glsl#normal"
//@include "vector.glsl#normalized_or"
//@include <facing>

vec3 clearcoat_normal(Surface surface) {
    return facing() * normalized_or(normal_world, vec3(0.0, 0.0, 1.0));
}

//@part normal_map implements clearcoat_normal
// The normal with the coat's own map, by the rules of normal.glsl#perturbed.

//@include "inputs.glsl#texcoord"
//@include "vector.glsl#normalized_or"
//@include <frame>
//@include <facing>

uniform sampler2D clearcoat_normal_texture;
uniform vec3 clearcoat_normal_scale;
uniform vec3 clearcoat_normal_bias;

vec3 clearcoat_normal_lookup = texture(clearcoat_normal_texture, texcoord_surface).xyz;

vec3 clearcoat_normal(Surface surface) {
    vec3 bend = clearcoat_normal_lookup * clearcoat_normal_scale + clearcoat_normal_bias;
    mat3 frame = world_from_tangent();
    vec3 bent_world = bend.x * frame[0] + bend.y * frame[1] + bend.z * frame[2];
    bool bends = dot(bend, bend) > 1e-12 && has_direction(bent_world);
    return facing() * normalized_or(bends ? bent_world : frame[2], vec3(0.0, 0.0, 1.0));
}

//@neutral clearcoat_normal
vec3 clearcoat_normal(Surface surface) { return surface.normal_world; }

//@part texture implements clearcoat_texture
// The weight from a texture: red.

//@include "inputs.glsl#texcoord"

uniform sampler2D clearcoat_texture;

float clearcoat_lookup = texture(clearcoat_texture, texcoord_surface).r;

float clearcoat_texel() { return clearcoat_lookup; }

//@neutral clearcoat_texture
float clearcoat_texel() { return 1.0; }

//@part roughness_texture implements clearcoat_roughness_texture
// The roughness from a texture: green.

//@include "inputs.glsl#texcoord"

uniform sampler2D clearcoat_roughness_texture;

float clearcoat_roughness_lookup = texture(clearcoat_roughness_texture, texcoord_surface).g;

float clearcoat_roughness_texel() { return clearcoat_roughness_lookup; }

//@neutral clearcoat_roughness_texture
float clearcoat_roughness_texel() { return 1.0; }

//@part roughness
// The roughness of the coat.

//@include "inputs.glsl#min_roughness"
//@include <clearcoat_roughness_texture>

uniform float clearcoat_roughness;

float coat_roughness() {
    return max(clearcoat_roughness * clearcoat_roughness_texel(), min_roughness);
}

//@part lights implements clearcoat_lights
// The highlights of light sources, before the layer's weight.

//@include "clearcoat.glsl#roughness"
//@include "metallic_roughness.glsl#ggx"
//@include "vector.glsl#normalized_or"
//@include <clearcoat_normal>

vec3 clearcoat_received = vec3(0.0);

void receive_clearcoat(Surface surface, vec3 light_world, vec3 irradiance) {
    vec3 normal = clearcoat_normal(surface);
    float n_dot_l = dot(normal, light_world);
    vec3 half_world = normalized_or(light_world + surface.view_world, vec3(0.0));
    if (!(n_dot_l > 0.0) || half_world == vec3(0.0)) return;
    float alpha = coat_roughness() * coat_roughness();
    float n_dot_v = max(dot(normal, surface.view_world), 0.0);
    clearcoat_received += irradiance * n_dot_l * facets(normal, half_world, alpha * alpha) *
                          visibility(n_dot_l, n_dot_v, alpha * alpha);
}

vec3 clearcoat_from_lights() { return clearcoat_received; }

//@neutral clearcoat_lights
void receive_clearcoat(Surface surface, vec3 light_world, vec3 irradiance) {}
vec3 clearcoat_from_lights() { return vec3(0.0); }

//@part ambient implements clearcoat_ambient
// Mirrored ambient light.

//@include "inputs.glsl#ambient"
//@include <occlusion>

vec3 clearcoat_from_ambient() { return ambient_scattered * occlusion(); }

//@neutral clearcoat_ambient
vec3 clearcoat_from_ambient() { return vec3(0.0); }

//@part reflection implements clearcoat_reflection
// The mirrored environment.

//@include "clearcoat.glsl#roughness"
//@include "environment.glsl#blurred"
//@include "environment.glsl#brdf_table"
//@include <clearcoat_normal>
//@include <clearcoat_bounces>
//@include <occlusion>

vec3 clearcoat_reflection(Surface surface) {
    vec3 normal = clearcoat_normal(surface);
    float n_dot_v = clamp(dot(normal, surface.view_world), 0.0, 1.0);
    vec2 factors = albedo_factors(n_dot_v, coat_roughness());
    float mirrored = factors.x + factors.y;
    vec3 mirrored_world = reflect(-surface.view_world, normal);
    return blurred_radiance(mirrored_world, coat_roughness()) * (mirrored * occlusion()) +
           clearcoat_bounces(normal, mirrored) * occlusion();
}

//@neutral clearcoat_reflection
vec3 clearcoat_reflection(Surface surface) { return vec3(0.0); }
