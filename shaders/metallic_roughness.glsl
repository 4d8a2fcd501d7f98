// SPDX-License-Identifier: Apache-2.0
// glTF's metallic-roughness model: the surface's parameters and its reflection of one light.
// ambient.glsl, environment.glsl and reflection.glsl hold the rest of the model.
// Source: glTF 2.0, appendix B, with KHR_materials_ior and KHR_materials_specular.

//@part surface implements surface
// Base color, metallic and roughness as the color that scatters, the reflectance at normal
// incidence, and the width of the GGX lobe. Roughness is large enough for its fourth power to be a
// normal float.

//@include "inputs.glsl#eye"
//@include "inputs.glsl#min_roughness"
//@include "vector.glsl#normalized_or"
//@include <position>
//@include <normal>
//@include <sharpness>
//@include <diffuse_texture>
//@include <vertex_color>
//@include <metallic_roughness>
//@include <dielectric>

uniform vec3 base_color;

struct Surface {
    vec3 normal_world;
    vec3 position_world;
    vec3 view_world;
    vec3 scattered_color;
    vec3 f0;
    float dielectric_share;  // 1 minus metallic.
    float roughness;
    float alpha_squared;  // The fourth power of roughness.
    vec3 highlight_gain;  // The factor of highlights that adds the light of further bounces.
};

//@include <highlight_gain>

Surface surface_here() {
    vec3 normal = shading_normal();
    vec3 base = base_color * diffuse_texel().rgb * vertex_tint().rgb;
    vec2 kind = clamp(metallic_and_roughness(), vec2(0.0), vec2(1.0));
    float widened_roughness = widened(max(kind.y, min_roughness));
    float alpha = widened_roughness * widened_roughness;
    Surface surface =
        Surface(normal, position_world, normalized_or(to_eye(position_world), normal),
                base * (1.0 - kind.x), mix(dielectric_reflectance(), base, kind.x), 1.0 - kind.x,
                widened_roughness, alpha * alpha, vec3(1.0));
    surface.highlight_gain = highlight_gain(surface);
    return surface;
}

//@part surface_colors implements surface
// The same without an orientation, for a surface that only ambient light reaches: the color that
// scatters and the reflectance at normal incidence.

//@include <diffuse_texture>
//@include <vertex_color>
//@include <metallic_roughness>
//@include <dielectric>

uniform vec3 base_color;

struct Surface {
    vec3 scattered_color;
    vec3 f0;
};

Surface surface_here() {
    vec3 base = base_color * diffuse_texel().rgb * vertex_tint().rgb;
    float metal = clamp(metallic_and_roughness().x, 0.0, 1.0);
    return Surface(base * (1.0 - metal), mix(dielectric_reflectance(), base, metal));
}

//@part dielectric implements dielectric
// The reflectance of dielectrics at normal incidence, from index, weight and color.
// Source: KHR_materials_ior, KHR_materials_specular.

//@include <specular_weight_texture>
//@include <specular_color_texture>

uniform vec3 dielectric_color;  // With the reflectance of the index.
uniform float dielectric_weight;

float reflection_weight() { return dielectric_weight * specular_weight_texel(); }

vec3 dielectric_reflectance() {
    return min(dielectric_color * specular_color_texel(), vec3(1.0)) * reflection_weight();
}

//@neutral dielectric
vec3 dielectric_reflectance() { return vec3(0.04); }

//@part weight_texture implements specular_weight_texture
// The weight of the reflection from a texture: alpha.

//@include "inputs.glsl#texcoord"

uniform sampler2D specular_weight_texture;

float specular_weight_lookup = texture(specular_weight_texture, texcoord_surface).a;

float specular_weight_texel() { return specular_weight_lookup; }

//@neutral specular_weight_texture
float specular_weight_texel() { return 1.0; }

//@part color_texture implements specular_color_texture
// The color of the reflection from a texture.

//@include "inputs.glsl#texcoord"

uniform sampler2D specular_color_texture;

vec3 specular_color_lookup = texture(specular_color_texture, texcoord_surface).rgb;

vec3 specular_color_texel() { return specular_color_lookup; }

//@neutral specular_color_texture
vec3 specular_color_texel() { return vec3(1.0); }

//@part grazing implements grazing
// The reflectance at grazing incidence, which the weight lowers; and the reflectance at normal
// incidence of the light that scattering lacks. It has the largest channel of the dielectric share,
// so that a colored reflection does not tint the scattered light. Source: KHR_materials_specular.

//@include "metallic_roughness.glsl#dielectric"

vec3 grazing_reflectance(Surface surface) {
    return vec3(1.0 + (reflection_weight() - 1.0) * surface.dielectric_share);
}

vec3 blocking_f0(Surface surface) {
    vec3 dielectric = dielectric_reflectance();
    float largest = max(max(dielectric.r, dielectric.g), dielectric.b);
    return surface.f0 + (vec3(largest) - dielectric) * surface.dielectric_share;
}

//@neutral grazing
vec3 grazing_reflectance(Surface surface) { return vec3(1.0); }
vec3 blocking_f0(Surface surface) { return surface.f0; }

//@part factors implements metallic_roughness
// Constant metallic and roughness.

//@include <roughness>

uniform float metallic;

vec2 metallic_and_roughness() { return vec2(metallic, roughness); }

//@part texture implements metallic_roughness
// Metallic and roughness from a texture: blue and green.

//@include "inputs.glsl#texcoord"
//@include <roughness>

uniform float metallic;
uniform sampler2D metallic_roughness_texture;

vec2 metallic_roughness_lookup = texture(metallic_roughness_texture, texcoord_surface).bg;

vec2 metallic_and_roughness() { return metallic_roughness_lookup * vec2(metallic, roughness); }

//@part roughness implements roughness
// The roughness as a factor. Only facets that lights or the environment reach show it.

uniform float roughness;

//@neutral roughness
const float roughness = 1.0;

//@part tint implements tint
// The color that multiplies scattered light: the non-metallic share of the base color.

vec3 scattering_tint(Surface surface) { return surface.scattered_color; }

//@part ggx
// GGX facets. 1 - (n.h)^2 is computed from the cross product, since a float next to 1 is too coarse
// for smooth surfaces. Source: [Walter et al. 2007].

// The root of alpha^2 / (pi D). A normal map may turn the normal away from the half vector; n.h then
// counts as 0. Its square alone would mirror the lobe to the other side of the surface.
float facet_spread(vec3 normal_world, vec3 half_world, float alpha_squared) {
    float n_dot_h = dot(normal_world, half_world);
    if (!(n_dot_h > 0.0)) return 1.0;
    vec3 across = cross(normal_world, half_world);
    return dot(across, across) + alpha_squared * n_dot_h * n_dot_h;
}

// GGX's D times pi.
float facets(vec3 normal_world, vec3 half_world, float alpha_squared) {
    float spread = facet_spread(normal_world, half_world, alpha_squared);
    return alpha_squared / (spread * spread);
}

// The squared length of a unit vector whose components in the surface are scaled by alpha.
float masking(float n_dot_v, float alpha_squared) {
    return n_dot_v * n_dot_v * (1.0 - alpha_squared) + alpha_squared;
}

// Smith's height-correlated masking and shadowing over 4 (n.l) (n.v).
float visibility(float n_dot_l, float n_dot_v, float alpha_squared) {
    float masked = n_dot_l * sqrt(masking(n_dot_v, alpha_squared));
    float shadowed = n_dot_v * sqrt(masking(n_dot_l, alpha_squared));
    return 0.5 / (masked + shadowed);
}

//@part lobe implements lobe
// The share of a light that facets mirror, before Fresnel's factor: pi D V.

//@include "metallic_roughness.glsl#ggx"

float mirrored_share(Surface surface, vec3 light_world, vec3 half_world, float n_dot_l,
                     float n_dot_v) {
    return facets(surface.normal_world, half_world, surface.alpha_squared) *
           visibility(n_dot_l, n_dot_v, surface.alpha_squared);
}

//@part receive implements receive
// Adds the light of one source: GGX facets mirror by Schlick's Fresnel factor, and the rest is
// scattered. pi is in the irradiance. If light and view are opposite, there is no half vector, and
// nothing is mirrored. Layers on top receive the light as well.

//@include "vector.glsl#normalized_or"
//@include <lobe>
//@include <grazing>
//@include <film>
//@include <sheen_lights>
//@include <clearcoat_lights>

void receive(Surface surface, vec3 light_world, vec3 irradiance, vec3 highlight_irradiance,
             inout Lighting lighting) {
    receive_sheen(surface, light_world, irradiance);
    receive_clearcoat(surface, light_world, irradiance);
    float n_dot_l = dot(surface.normal_world, light_world);
    if (!(n_dot_l > 0.0)) return;
    vec3 received = irradiance * n_dot_l;
    vec3 half_world = normalized_or(light_world + surface.view_world, vec3(0.0));
    if (half_world == vec3(0.0)) {
        lighting.scattered += received;
        return;
    }
    float v_dot_h = clamp(dot(surface.view_world, half_world), 0.0, 1.0);
    float m = 1.0 - v_dot_h;
    float towards_grazing = m * m * m * m * m;
    vec3 f90 = grazing_reflectance(surface);
    vec3 fresnel = with_film(surface, v_dot_h, 1.0,
                             surface.f0 + (f90 - surface.f0) * towards_grazing);
    vec3 blocking = blocking_f0(surface);
    vec3 blocked = blocked_by_film(surface, v_dot_h, 1.0,
                                   blocking + (f90 - blocking) * towards_grazing);
    float n_dot_v = max(dot(surface.normal_world, surface.view_world), 0.0);
    float mirrored = mirrored_share(surface, light_world, half_world, n_dot_l, n_dot_v);
    lighting.scattered += received * (vec3(1.0) - blocked);
    lighting.highlights += received * fresnel * mirrored * surface.highlight_gain;
}
