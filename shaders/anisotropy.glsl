// SPDX-License-Identifier: Apache-2.0
// GGX facets that are rougher along a direction of the surface, as on brushed metal. The lobe is
// that of metallic_roughness.glsl plus terms that are 0 without anisotropy.
// Source: KHR_materials_anisotropy. Unlike there, the direction is made perpendicular to the
// shading normal, so that D covers the surface under a normal map, too.

//@part axis
// The direction of the larger roughness, unit and perpendicular to the normal, and the strength.
// Without a tangent frame, the strength is 0.

//@include "vector.glsl#normalized_or"
//@include <frame>
//@include <anisotropy_texture>

uniform float anisotropy;
uniform vec2 anisotropy_direction;  // In the tangent frame.

struct Anisotropy {
    vec3 rough_axis_world;
    vec3 smooth_axis_world;  // Perpendicular to the normal and to the rough axis.
    float strength;
};

Anisotropy anisotropy_of(Surface surface) {
    mat3 frame = world_from_tangent();
    vec3 texel = anisotropy_texel();
    vec2 turned = vec2(anisotropy_direction.x * texel.x - anisotropy_direction.y * texel.y,
                       anisotropy_direction.y * texel.x + anisotropy_direction.x * texel.y);
    vec3 along = turned.x * frame[0] + turned.y * frame[1];
    vec3 normal = surface.normal_world;
    vec3 axis = normalized_or(along - normal * dot(normal, along), vec3(0.0));
    return Anisotropy(axis, cross(normal, axis), axis == vec3(0.0) ? 0.0 : anisotropy * texel.z);
}

//@part texture implements anisotropy_texture
// Direction and strength from a texture. A texel without a direction counts as the tangent.

//@include "inputs.glsl#texcoord"
//@include "vector.glsl#normalized_or"

uniform sampler2D anisotropy_texture;

vec3 anisotropy_lookup = texture(anisotropy_texture, texcoord_surface).rgb;

vec3 anisotropy_texel() {
    vec2 stored = 2.0 * anisotropy_lookup.rg - 1.0;
    vec3 direction = normalized_or(vec3(stored, 0.0), vec3(1.0, 0.0, 0.0));
    return vec3(direction.xy, anisotropy_lookup.b);
}

//@neutral anisotropy_texture
vec3 anisotropy_texel() { return vec3(1.0, 0.0, 1.0); }

//@part lobe implements lobe
// The share of a light that facets mirror, before Fresnel's factor: pi D V.

//@include "metallic_roughness.glsl#ggx"
//@include "anisotropy.glsl#axis"

float mirrored_share(Surface surface, vec3 light_world, vec3 half_world, float n_dot_l,
                     float n_dot_v) {
    Anisotropy a = anisotropy_of(surface);
    float alpha = surface.roughness * surface.roughness;
    // alpha_t / alpha - 1, and (alpha_t / alpha)^2 - 1.
    float longer = (1.0 - alpha) / alpha * (a.strength * a.strength);
    float wider = longer * (2.0 + longer);

    float n_dot_h = max(dot(surface.normal_world, half_world), 0.0);
    float b_dot_h = dot(a.smooth_axis_world, half_world);
    float spread =
        facet_spread(surface.normal_world, half_world, surface.alpha_squared) +
        wider * (b_dot_h * b_dot_h + surface.alpha_squared * (n_dot_h * n_dot_h));
    float ratio = 1.0 + longer;
    float distribution = surface.alpha_squared * (ratio * ratio * ratio) / (spread * spread);

    float t_dot_v = dot(a.rough_axis_world, surface.view_world);
    float t_dot_l = dot(a.rough_axis_world, light_world);
    float more = surface.alpha_squared * wider;
    float masked =
        n_dot_l * sqrt(masking(n_dot_v, surface.alpha_squared) + more * (t_dot_v * t_dot_v));
    float shadowed =
        n_dot_v * sqrt(masking(n_dot_l, surface.alpha_squared) + more * (t_dot_l * t_dot_l));
    return distribution * (0.5 / (masked + shadowed));
}

//@part albedo implements lobe_albedo
// The albedo of an isotropic lobe with nearly the same losses: its width is between those of both
// axes, and its cosine gives the same masking. White facets reflect 0.92 to 1.03 of even light, and
// 0.98 to 1.02 in the mean over all views. Without anisotropy, the albedo is the lobe's own.

//@include "anisotropy.glsl#axis"
//@include "environment.glsl#brdf_table"

vec2 lobe_albedo(Surface surface, float n_dot_v) {
    Anisotropy a = anisotropy_of(surface);
    float alpha = surface.roughness * surface.roughness;
    // alpha_t / alpha - 1, and (alpha_t / alpha)^2 - 1.
    float longer = (1.0 - alpha) / alpha * (a.strength * a.strength);
    float wider = longer * (2.0 + longer);
    // The squared ratio of the lobe's width to alpha, minus 1.
    float gain = 0.5 * wider - 0.05 * (longer * longer);
    float t_dot_v = dot(a.rough_axis_world, surface.view_world);
    float masked = (wider * (t_dot_v * t_dot_v) - gain * (1.0 - n_dot_v * n_dot_v)) / (1.0 + gain);
    return albedo_factors(n_dot_v / sqrt(1.0 + masked),
                          surface.roughness * sqrt(sqrt(1.0 + gain)));
}

//@part mirror_normal implements mirror_normal
// The normal that mirrors the environment: it leans towards the eye across the rough axis, so that
// the blurred picture is stretched. Source: glTF Sample Renderer, getIBLRadianceAnisotropy.

//@include "anisotropy.glsl#axis"

vec3 mirror_normal(Surface surface) {
    Anisotropy a = anisotropy_of(surface);
    vec3 view = surface.view_world;
    vec3 leaning = view - a.smooth_axis_world * dot(a.smooth_axis_world, view);
    float kept = 1.0 - a.strength * (1.0 - surface.roughness);
    float kept_squared = kept * kept;
    float lean = 1.0 - kept_squared * kept_squared;
    vec3 normal = surface.normal_world;
    return lean > 0.0 ? normalized_or(mix(normal, leaning, lean), normal) : normal;
}

//@neutral mirror_normal
vec3 mirror_normal(Surface surface) { return surface.normal_world; }
