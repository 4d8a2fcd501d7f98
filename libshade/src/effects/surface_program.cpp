// SPDX-License-Identifier: Apache-2.0
// The table of shader parts: one row per step, with the parts that implement it, and the programs
// that are assembled from it. At most one part of a step is chosen for any Features value. Pure.
// Tests: tests/shade/effects/shader_source_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "effects/features.h"
#include "effects/light_rows.h"
#include "effects/shader_source.h"
#include "relief/shade/effects.h"

namespace relief {

namespace {

/// The inputs of a part from outside the shader, by GLSL name: those of its own declarations and
/// those of the parts that it includes by address.
struct Takes {
    std::vector<std::string_view> attributes = {};
    std::vector<std::string_view> uniforms = {};
    std::vector<std::string_view> samplers = {};
    std::vector<std::string_view> blocks = {};
};

/// A part that implements a step, and whether these features choose it.
struct Part {
    std::string_view address;
    bool chosen = false;
    Takes takes = {};
};

/// A step of a stage. If no part is chosen, its code is the neutral line; a step without one is
/// then not included by any chosen part.
struct Step {
    std::string_view name;
    std::string_view neutral;
    std::vector<Part> parts;
};

using Steps = std::vector<Step>;

using By = const Features&;

bool has_lights(By f) {
    return light_count(f) > 0;
}
bool has_positional_lights(By f) {
    return f.point_lights + f.spot_lights > 0;
}
bool has_shadow(By f) {
    return f.shadow != ShadowTerm::none;
}
bool is_gouraud(By f) {
    return f.interpolation == Interpolation::gouraud;
}
bool is_flat(By f) {
    return f.interpolation == Interpolation::flat;
}

/// True if the surface under sheen and coat sends light to the eye, apart from its emission.
bool has_lit_base(By f) {
    return has_lights(f) || f.ambient || f.environment_diffuse ||
           f.reflection != ReflectionTerm::none || transmits(f);
}
/// True if glTF's roughness and Fresnel factors show. Ambient light has neither.
bool has_lit_facets(By f) {
    return has_lights(f) || f.environment_diffuse || f.reflection != ReflectionTerm::none ||
           transmits(f);
}

/// The values that a stage needs of the surface.
struct Needs {
    bool lights = false;
    bool normal = false;
    bool position = false;  ///< For point and spot lights.
    bool view = false;      ///< For highlights and mirror images: position and eye.
};

/// \param lights  the stage computes them  \param rest  and everything else that shows the normal
Needs needs_of(By f, bool lights, bool rest) {
    const bool shows_view = rest && (reflection_shows_view(f) || transmits(f));
    const bool shows_normal = shows_view || (rest && reflection_shows_normal(f));
    const bool lit_around = rest && f.environment_diffuse;
    Needs needs;
    needs.lights = lights && has_lights(f);
    const bool layered = rest && (f.sheen || f.clearcoat);
    needs.normal = needs.lights || shows_normal || lit_around || layered;
    needs.position = needs.lights && has_positional_lights(f);
    needs.view = (needs.lights && f.specular != SpecularTerm::none) || shows_view || layered ||
                 (f.metallic_roughness && needs.normal);
    return needs;
}

Needs vertex_needs(By f) {
    return needs_of(f, is_gouraud(f), false);
}
Needs fragment_needs(By f) {
    Needs needs = needs_of(f, !is_gouraud(f), true);
    needs.normal |= shows_normal(f);
    return needs;
}

/// True if a map in the tangent frame perturbs the normal.
bool is_perturbed(By f) {
    const bool tangent_space =
        f.detail == NormalDetail::normal_map || f.detail == NormalDetail::bump_map;
    return tangent_space && fragment_needs(f).normal;
}
bool has_frame(By f) {
    return is_perturbed(f) || f.anisotropy || f.clearcoat_normal_map || shows_frame(f);
}
bool has_stored_frame(By f) {
    return has_frame(f) && f.frame == TangentFrame::stored;
}
bool has_derived_frame(By f) {
    return has_frame(f) && f.frame == TangentFrame::derivatives;
}
/// True if the map's vector in tangent space is needed.
bool has_detail(By f, NormalDetail detail) {
    return f.detail == detail && (is_perturbed(f) || f.view == DebugView::normal_map);
}

bool passes_position(By f) {
    const Needs here = fragment_needs(f);
    const Needs at_vertex = vertex_needs(f);
    return here.position || here.view || at_vertex.position || at_vertex.view ||
           has_derived_frame(f) || (here.normal && is_flat(f));
}
bool passes_normal(By f) {
    return has_frame(f) || vertex_needs(f).normal || (fragment_needs(f).normal && !is_flat(f));
}
bool passes_texcoord(By f) {
    bool is_looked_up = false;
    for_each_sampled(f, [&](const SecondTexture&, bool is_second) { is_looked_up |= !is_second; });
    return is_looked_up || f.detail != NormalDetail::none || has_derived_frame(f) ||
           f.clearcoat_normal_map || f.anisotropy_texture || f.view == DebugView::texcoords;
}

constexpr std::string_view neutral_sharpness =
    "float sharpened(float exponent) { return exponent; } "
    "float dimmed(float exponent) { return 1.0; } "
    "float widened(float roughness) { return roughness; }";

/// Returns the steps of the deformation of the mesh, in the vertex stage.
Steps deformation_steps(By f) {
    const bool normal = passes_normal(f) && is_deformed(f);
    return {
        {"morphing",
         "vec3 morphed(vec3 at_rest, int vertex, int component) { return at_rest; }",
         {{"vertex.glsl#morphing",
           f.morphing,
           {.uniforms = {"morph_layout"}, .samplers = {"morph_displacements", "morph_weights"}}}}},
        {"skinning",
         "vec3 skinned_point(vec3 point, int vertex) { return point; }",
         {{"vertex.glsl#skinning",
           f.skinning,
           {.uniforms = {"joint_pairs"}, .samplers = {"joint_matrices", "joint_weights"}}}}},
        {"skinned_directions",
         "vec3 skinned_normal(vec3 normal) { return normal; } "
         "vec3 skinned_tangent(vec3 tangent) { return tangent; }",
         {{"vertex.glsl#skinned_directions", f.skinning && normal}}},
        {"deformed_normal",
         "vec3 deformed_normal() { return normal_object; }",
         {{"vertex.glsl#deformed_normal", normal && !f.deformed_facets},
          {"vertex.glsl#facet_normal",
           normal && f.deformed_facets,
           {.samplers = {"facet_corners"}}}}},
        {"deformed_tangent",
         "vec3 deformed_tangent() { return tangent_object.xyz; }",
         {{"vertex.glsl#deformed_tangent", has_stored_frame(f) && is_deformed(f)}}},
    };
}

/// Returns the steps of the vertex attributes that pass to the fragment stage.
Steps passing_steps(By f) {
    const bool framed = has_stored_frame(f);
    return {
        {"pass_position",
         "void pass_position() {}",
         {{"vertex.glsl#position", passes_position(f), {.uniforms = {"world_from_object"}}}}},
        {"pass_normal",
         "void pass_normal() {}",
         {{"vertex.glsl#normal",
           passes_normal(f) && !framed,
           {.attributes = {"normal_object"}, .uniforms = {"world_from_object_normal"}}},
          {"vertex.glsl#normal_and_tangent",
           framed,
           {.attributes = {"normal_object", "tangent_object"},
            .uniforms = {"world_from_object_normal", "world_from_object_tangent", "handedness"}}}}},
        {"pass_texcoord",
         "void pass_texcoord() {}",
         {{"vertex.glsl#texcoord", passes_texcoord(f), {.attributes = {"texcoord"}}}}},
        {"pass_texcoord_2",
         "void pass_texcoord_2() {}",
         {{"vertex.glsl#texcoord_2", f.second_texcoords != 0, {.attributes = {"texcoord_2"}}}}},
        {"pass_color",
         "void pass_color() {}",
         {{"vertex.glsl#color", f.vertex_colors, {.attributes = {"color_linear"}}}}},
        {"pass_occlusion",
         "void pass_occlusion() {}",
         {{"ambient.glsl#pass_occlusion", f.vertex_occlusion, {.samplers = {"hidden_shares"}}}}},
        {"pass_shadow",
         "void pass_shadow() {}",
         {{"shadow.glsl#pass", has_shadow(f), {.uniforms = {"shadow_from_object"}}}}},
    };
}

/// Returns the step of the values of the surface at a point.
Step surface_step(By f, const Needs& needs) {
    const bool physical = f.metallic_roughness && has_lit_base(f);
    Takes facets{.uniforms = {"eye_world", "base_color", "metallic"}};
    if (has_lit_facets(f)) facets.uniforms.emplace_back("roughness");
    return {"surface",
            "",
            {{"surface.glsl#none", !needs.normal && !physical},
             {"surface.glsl#normal", needs.normal && !needs.position && !needs.view},
             {"surface.glsl#position", needs.position && !needs.view},
             {"surface.glsl#view", needs.view && !physical, {.uniforms = {"eye_world"}}},
             {"metallic_roughness.glsl#surface_colors",
              physical && !needs.normal,
              {.uniforms = {"base_color", "metallic"}}},
             {"metallic_roughness.glsl#surface", physical && needs.normal, facets}}};
}

/// Returns the steps of the reflectance of glTF's dielectrics.
Steps dielectric_steps(By f) {
    const bool own = f.dielectric_reflectance;
    const bool by_angle = own && has_lit_facets(f);
    return {{"dielectric",
             "vec3 dielectric_reflectance() { return vec3(0.04); }",
             {{"metallic_roughness.glsl#dielectric",
               own,
               {.uniforms = {"dielectric_color", "dielectric_weight"}}}}},
            {"specular_weight_texture",
             "float specular_weight_texel() { return 1.0; }",
             {{"metallic_roughness.glsl#weight_texture",
               f.specular_weight_texture,
               {.samplers = {"specular_weight_texture"}}}}},
            {"specular_color_texture",
             "vec3 specular_color_texel() { return vec3(1.0); }",
             {{"metallic_roughness.glsl#color_texture",
               f.specular_color_texture,
               {.samplers = {"specular_color_texture"}}}}},
            {"grazing",
             "vec3 grazing_reflectance(Surface surface) { return vec3(1.0); } "
             "vec3 blocking_f0(Surface surface) { return surface.f0; }",
             {{"metallic_roughness.glsl#grazing",
               by_angle,
               {.uniforms = {"dielectric_color", "dielectric_weight"}}}}}};
}

/// Returns the steps of the light that bounces between glTF's facets. Canonical features have it
/// only where it shows.
Steps energy_steps(By f, bool lit_in_this_stage) {
    const bool kept = f.energy_compensation;
    return {
        {"highlight_gain",
         "vec3 highlight_gain(Surface surface) { return vec3(1.0); }",
         {{"energy_compensation.glsl#highlights",
           kept && lit_in_this_stage && f.view != DebugView::diffuse,
           {.uniforms = {"energy_compensation"}, .samplers = {"environment_brdf"}}}}},
        {"scattering_bounces",
         "vec3 with_blocked_bounces(Surface surface, float n_dot_v, vec2 factors, vec3 blocked) "
         "{ return blocked; }",
         {{"energy_compensation.glsl#scattering",
           kept && f.environment_diffuse,
           {.uniforms = {"energy_compensation"}}}}},
        {"bounced_light",
         "vec3 with_bounced_light(Surface surface, vec3 mirrored, vec3 radiance) "
         "{ return radiance; }",
         {{"energy_compensation.glsl#reflection",
           kept && f.reflection != ReflectionTerm::none,
           {.uniforms = {"energy_compensation"}}}}}};
}

/// Returns the step of the thin film on glTF's facets.
Steps film_steps(By f) {
    return {{"film",
             "vec3 with_film(Surface surface, float cosine, float share, vec3 mirrored) "
             "{ return mirrored; } "
             "vec3 blocked_by_film(Surface surface, float cosine, float share, vec3 blocked) "
             "{ return blocked; }",
             {{"iridescence.glsl#film",
               f.iridescence,
               {.uniforms = {"iridescence", "iridescence_index", "iridescence_thickness"}}}}},
            {"iridescence_texture",
             "float iridescence_texel() { return 1.0; }",
             {{"iridescence.glsl#texture",
               f.iridescence_texture,
               {.samplers = {"iridescence_texture"}}}}},
            {"film_thickness",
             "",
             {{"iridescence.glsl#thickness", f.iridescence && !f.film_thickness_texture},
              {"iridescence.glsl#thickness_texture",
               f.film_thickness_texture,
               {.uniforms = {"iridescence_thickness_minimum"},
                .samplers = {"film_thickness_texture"}}}}}};
}

/// Returns the steps of what shows through glTF's surfaces.
Steps transmission_steps(By f) {
    return {{"transmission",
             "vec3 with_transmission(Surface surface, vec3 scattered) { return scattered; }",
             {{"refraction.glsl#transmission_dimming",
               f.transmission && !transmits(f),
               {.uniforms = {"transmission"}}},
              {"refraction.glsl#transmission",
               transmits(f),
               {.uniforms = {"transmission", "blurred_level", "background_radiance"},
                .samplers = {"behind"}}}}},
            {"transmission_texture",
             "float transmission_texel() { return 1.0; }",
             {{"refraction.glsl#transmission_texture",
               f.transmission_texture,
               {.samplers = {"transmission_texture"}}}}},
            {"path",
             "",
             {{"refraction.glsl#thin", transmits(f) && !f.volume},
              {"refraction.glsl#volume",
               f.volume,
               {.uniforms = {"clip_from_world", "thickness", "object_scale", "absorption",
                             "volume_index_ratio"}}}}},
            {"thickness_texture",
             "float thickness_texel() { return 1.0; }",
             {{"refraction.glsl#thickness_texture",
               f.thickness_texture,
               {.samplers = {"thickness_texture"}}}}}};
}

/// Returns the steps of glTF's facets. Canonical features have anisotropy only where it shows.
Steps facet_steps(By f, bool in_this_stage) {
    const bool lit = in_this_stage && has_lights(f) && f.metallic_roughness;
    const bool mirrors = f.anisotropy && f.reflection != ReflectionTerm::none;
    const Takes anisotropy{.uniforms = {"anisotropy", "anisotropy_direction"}};
    return {{"lobe",
             "",
             {{"metallic_roughness.glsl#lobe", lit && !f.anisotropy},
              {"anisotropy.glsl#lobe", lit && f.anisotropy, anisotropy}}},
            {"mirror_normal",
             "vec3 mirror_normal(Surface surface) { return surface.normal_world; }",
             {{"anisotropy.glsl#mirror_normal", mirrors, anisotropy}}},
            {"anisotropy_texture",
             "vec3 anisotropy_texel() { return vec3(1.0, 0.0, 1.0); }",
             {{"anisotropy.glsl#texture",
               f.anisotropy_texture,
               {.samplers = {"anisotropy_texture"}}}}}};
}

/// Returns the steps of the layers on glTF's surfaces. A view of one term has the layers' share of
/// that term; their highlights belong to highlights.
Steps layer_steps(By f) {
    const bool highlights = has_lights(f) && f.view != DebugView::diffuse;
    const bool mirrors = f.clearcoat && f.reflection != ReflectionTerm::none;
    return {
        {"sheen",
         "vec3 with_sheen(Surface surface, vec3 radiance) { return radiance; }",
         {{"sheen.glsl#layer", f.sheen, {.uniforms = {"sheen_color"}}}}},
        {"sheen_albedo",
         "",
         {{"sheen.glsl#albedo",
           f.sheen && !f.sheen_roughness_texture,
           {.uniforms = {"sheen_albedo"}}},
          {"sheen.glsl#albedo_by_texture",
           f.sheen_roughness_texture,
           {.uniforms = {"sheen_albedo", "sheen_albedo_rows"},
            .samplers = {"sheen_roughness_texture"}}}}},
        {"sheen_color_texture",
         "vec3 sheen_color_texel() { return vec3(1.0); }",
         {{"sheen.glsl#color_texture",
           f.sheen_color_texture,
           {.samplers = {"sheen_color_texture"}}}}},
        {"sheen_lights",
         "void receive_sheen(Surface surface, vec3 light_world, vec3 irradiance) {} "
         "vec3 sheen_from_lights() { return vec3(0.0); }",
         {{"sheen.glsl#lights", f.sheen && highlights}}},
        {"sheen_width",
         "",
         {{"sheen.glsl#width",
           f.sheen && highlights && !f.sheen_roughness_texture,
           {.uniforms = {"sheen_alpha"}}},
          {"sheen.glsl#width_by_texture",
           f.sheen_roughness_texture && highlights,
           {.uniforms = {"sheen_roughness"}, .samplers = {"sheen_roughness_texture"}}}}},
        {"sheen_ambient",
         "vec3 sheen_from_ambient() { return vec3(0.0); }",
         {{"sheen.glsl#ambient", f.sheen && f.ambient, {.uniforms = {"ambient_scattered"}}}}},
        {"sheen_environment",
         "vec3 sheen_from_environment(Surface surface) { return vec3(0.0); }",
         {{"sheen.glsl#environment",
           f.sheen && f.environment_diffuse,
           {.uniforms = {"irradiance_sh"}}}}},
        {"clearcoat",
         "vec3 with_clearcoat(Surface surface, vec3 radiance) { return radiance; }",
         {{"clearcoat.glsl#layer", f.clearcoat, {.uniforms = {"clearcoat", "eye_world"}}}}},
        {"clearcoat_normal",
         "vec3 clearcoat_normal(Surface surface) { return surface.normal_world; }",
         {{"clearcoat.glsl#normal",
           f.clearcoat && !f.clearcoat_normal_map && f.detail != NormalDetail::none},
          {"clearcoat.glsl#normal_map",
           f.clearcoat_normal_map,
           {.uniforms = {"clearcoat_normal_scale", "clearcoat_normal_bias"},
            .samplers = {"clearcoat_normal_texture"}}}}},
        {"clearcoat_texture",
         "float clearcoat_texel() { return 1.0; }",
         {{"clearcoat.glsl#texture", f.clearcoat_texture, {.samplers = {"clearcoat_texture"}}}}},
        {"clearcoat_roughness_texture",
         "float clearcoat_roughness_texel() { return 1.0; }",
         {{"clearcoat.glsl#roughness_texture",
           f.clearcoat_roughness_texture,
           {.samplers = {"clearcoat_roughness_texture"}}}}},
        {"clearcoat_lights",
         "void receive_clearcoat(Surface surface, vec3 light_world, vec3 irradiance) {} "
         "vec3 clearcoat_from_lights() { return vec3(0.0); }",
         {{"clearcoat.glsl#lights",
           f.clearcoat && highlights,
           {.uniforms = {"clearcoat_roughness"}}}}},
        {"clearcoat_ambient",
         "vec3 clearcoat_from_ambient() { return vec3(0.0); }",
         {{"clearcoat.glsl#ambient",
           f.clearcoat && f.ambient,
           {.uniforms = {"ambient_scattered"}}}}},
        {"clearcoat_reflection",
         "vec3 clearcoat_reflection(Surface surface) { return vec3(0.0); }",
         {{"clearcoat.glsl#reflection",
           mirrors,
           {.uniforms = {"clearcoat_roughness", "environment_intensity", "blurred_levels"},
            .samplers = {"blurred_environment", "environment_brdf"}}}}},
    };
}

/// Returns the steps of the normal at a fragment.
Steps normal_steps(By f) {
    const bool normal = fragment_needs(f).normal;
    const bool object_map = normal && f.detail == NormalDetail::object_normal_map;
    return {
        {"position", "", {{"inputs.glsl#position", true}}},
        {"normal",
         "",
         {{"normal.glsl#flat", normal && is_flat(f), {.uniforms = {"eye_world"}}},
          {"normal.glsl#interpolated", normal && !is_flat(f) && f.detail == NormalDetail::none},
          {"normal.glsl#perturbed", is_perturbed(f)},
          {"normal_map.glsl#object_space",
           object_map,
           {.uniforms = {"normal_map_scale", "normal_map_bias", "world_from_object_normal"},
            .samplers = {"normal_texture"}}}}},
        {"detail",
         "",
         {{"normal_map.glsl#tangent_space",
           has_detail(f, NormalDetail::normal_map),
           {.uniforms = {"normal_map_scale", "normal_map_bias"}, .samplers = {"normal_texture"}}},
          {"bump_map.glsl",
           has_detail(f, NormalDetail::bump_map),
           {.uniforms = {"bump_strength"}, .samplers = {"bump_texture"}}}}},
        {"frame",
         "",
         {{"tangent_frame.glsl#stored", has_stored_frame(f)},
          {"tangent_frame.glsl#derivatives", has_derived_frame(f)}}},
        {"facing",
         "float facing() { return 1.0; }",
         {{"normal.glsl#both_sides", normal && f.double_sided}}},
        {"sharpness",
         neutral_sharpness,
         {{"specular_antialiasing.glsl",
           f.specular_antialiasing,
           {.uniforms = {"normal_map_unscale", "normal_map_rounding"}}}}},
    };
}

/// Returns the steps of lights of every kind, in the stage that computes them.
Steps light_steps(By f, bool in_this_stage) {
    const bool any = in_this_stage && has_lights(f);
    const bool positional = in_this_stage && has_positional_lights(f);
    const Takes shadow{
        .uniforms = {"shadow_lift", "shadow_shift", "shadow_samples", "shadow_points"},
        .samplers = {"shadow_maps"}};
    return {
        {"light_rows",
         "",
         {{"light.glsl#rows_block", any && !f.lights_in_buffer, {.blocks = {"Lights"}}},
          {"light.glsl#rows_buffer", any && f.lights_in_buffer, {.samplers = {"light_buffer"}}}}},
        {"directional_lights",
         "void add_directional_lights(Surface surface, inout Lighting lighting) {}",
         {{"light.glsl#directional", any && f.directional_lights > 0}}},
        {"point_lights",
         "void add_point_lights(Surface surface, inout Lighting lighting) {}",
         {{"light.glsl#point", any && f.point_lights > 0}}},
        {"spot_lights",
         "void add_spot_lights(Surface surface, inout Lighting lighting) {}",
         {{"light.glsl#spot", any && f.spot_lights > 0}}},
        {"highlight_row",
         "vec3 highlight_power(int row, vec3 power) { return power; }",
         {{"light.glsl#highlight_row", any && f.highlight_colors}}},
        {"distance_law",
         "",
         {{"falloff.glsl#inverse_square", positional && f.falloff == FalloffTerm::inverse_square},
          {"falloff.glsl#none", positional && f.falloff == FalloffTerm::none},
          {"falloff.glsl#mixed", positional && f.falloff == FalloffTerm::mixed}}},
        {"directional_shadow",
         "float directional_share(Surface surface) { return 1.0; }",
         {{"shadow.glsl#directional", any && f.shadow == ShadowTerm::directional_light, shadow}}},
        {"point_shadow",
         "float point_share(Surface surface) { return 1.0; }",
         {{"shadow.glsl#point", any && f.shadow == ShadowTerm::point_light, shadow}}},
        {"spot_shadow",
         "float spot_share(Surface surface) { return 1.0; }",
         {{"shadow.glsl#spot", any && f.shadow == ShadowTerm::spot_light, shadow}}},
        {"range",
         "float within_range(float distance_squared, float inverse_range) { return 1.0; }",
         {{"falloff.glsl#range", positional && f.light_ranges}}},
    };
}

/// Returns the steps of the surface's response to a light.
Steps scattering_steps(By f, bool in_this_stage) {
    const bool lit = in_this_stage && has_lights(f);
    const bool phong = lit && !f.metallic_roughness;
    const bool highlights = phong && f.specular != SpecularTerm::none;
    const Takes highlight{.uniforms = {"shininess"}};
    return {
        {"receive",
         "",
         {{"metallic_roughness.glsl#receive", lit && f.metallic_roughness},
          {"phong.glsl#receive", phong}}},
        {"diffuse",
         "vec3 diffuse_scattering(float n_dot_l) { return vec3(0.0); }",
         {{"phong.glsl#lambert", phong && f.diffuse, {.uniforms = {"diffuse_color"}}}}},
        {"specular",
         "vec3 specular_highlight(Surface surface, vec3 light_world) { return vec3(0.0); }",
         {{"phong.glsl#phong", phong && f.specular == SpecularTerm::phong, highlight},
          {"phong.glsl#blinn_phong", phong && f.specular == SpecularTerm::blinn_phong, highlight}}},
        {"highlight_color",
         "",
         {{"phong.glsl#color",
           highlights && !f.highlight_fresnel,
           {.uniforms = {"specular_color"}}},
          {"phong.glsl#fresnel_color",
           highlights && f.highlight_fresnel,
           {.uniforms = {"specular_color", "specular_gain"}}}}},
    };
}

/// Returns the step that clamps the terms of Phong's model.
/// \param adds_terms  the stage adds any
Step term_step(By f, bool adds_terms) {
    return {"term_limit",
            "vec3 limited(vec3 term) { return term; }",
            {{"phong.glsl#clamped_terms", f.clamped_terms && adds_terms}}};
}

/// Returns the steps of ambient light and the environment's light.
Steps ambient_steps(By f) {
    const bool physical = f.metallic_roughness;
    return {
        {"ambient",
         "void add_ambient(Surface surface, inout Lighting lighting) {}",
         {{"ambient.glsl#phong", f.ambient && !physical, {.uniforms = {"ambient_scattered"}}},
          {"ambient.glsl#metallic_roughness",
           f.ambient && physical,
           {.uniforms = {"ambient_scattered"}}}}},
        {"environment_light",
         "void add_environment_light(Surface surface, inout Lighting lighting) {}",
         {{"environment.glsl#light_phong",
           f.environment_diffuse && !physical,
           {.uniforms = {"diffuse_color", "irradiance_sh"}}},
          {"environment.glsl#light_metallic_roughness",
           f.environment_diffuse && physical,
           {.uniforms = {"irradiance_sh"}, .samplers = {"environment_brdf"}}}}},
        {"occlusion",
         "float occlusion() { return 1.0; }",
         {{"ambient.glsl#occlusion",
           f.occlusion_texture,
           {.uniforms = {"occlusion_strength"}, .samplers = {"occlusion_texture"}}},
          {"ambient.glsl#occlusion_by_vertex", f.vertex_occlusion && !f.occlusion_texture}}},
        {"open_share",
         "float open_share() { return 1.0; }",
         {{"ambient.glsl#open_share", f.vertex_occlusion}}},
    };
}

/// Returns the steps of textures and colors that multiply.
Steps color_steps(By f) {
    const bool physical = f.metallic_roughness && has_lit_base(f);
    // Lights of glTF's model scatter and mirror at once; a view of one of the two blackens the
    // other.
    const bool black_scattering = physical && f.view == DebugView::specular;
    const bool black_highlights = physical && f.view == DebugView::diffuse;
    return {
        {"tint",
         "",
         {{"color.glsl#tint", !physical},
          {"metallic_roughness.glsl#tint", physical && !black_scattering},
          {"view.glsl#no_scattering", black_scattering}}},
        {"diffuse_texture",
         "vec4 diffuse_texel() { return vec4(1.0); }",
         {{"color.glsl#diffuse_texture", f.diffuse_texture, {.samplers = {"diffuse_texture"}}}}},
        {"environment_tint",
         "vec3 environment_tint(Surface surface) { return vec3(1.0); }",
         {{"color.glsl#environment_tint",
           f.environment_tint,
           {.uniforms = {"environment_intensity"}, .samplers = {"environment"}}}}},
        {"vertex_color",
         "vec4 vertex_tint() { return vec4(1.0); }",
         {{"color.glsl#vertex", f.vertex_colors}}},
        {"specular_texture",
         "vec3 specular_texture_color() { return vec3(1.0); }",
         {{"view.glsl#no_highlights", black_highlights},
          {"color.glsl#specular_texture", f.specular_texture, {.samplers = {"specular_texture"}}}}},
        {"metallic_roughness",
         "",
         {{"metallic_roughness.glsl#factors", !f.metallic_roughness_texture},
          {"metallic_roughness.glsl#texture",
           f.metallic_roughness_texture,
           {.samplers = {"metallic_roughness_texture"}}}}},
        {"emission",
         "vec3 emitted_radiance() { return vec3(0.0); }",
         {{"emission.glsl#color",
           f.emission && !f.emission_texture,
           {.uniforms = {"emission_color"}}},
          {"emission.glsl#texture",
           f.emission && f.emission_texture,
           {.uniforms = {"emission_color"}, .samplers = {"emission_texture"}}}}},
    };
}

/// Returns the step of the second texture coordinates, at which at_second_texcoords() looks up.
Step second_texcoord_step(By f) {
    return {"second_texcoord",
            "// Textures are looked up at one set of texture coordinates.",
            {{"inputs.glsl#texcoord_2", f.second_texcoords != 0}}};
}

Steps alpha_steps(By f) {
    return {
        {"alpha",
         "float alpha_here() { return 1.0; } void cut_holes() {}",
         {{"alpha.glsl#mask",
           f.alpha == AlphaMode::mask,
           {.uniforms = {"opacity", "alpha_cutoff"}}},
          {"alpha.glsl#blend", f.alpha == AlphaMode::blend, {.uniforms = {"opacity"}}}}},
        {"opacity_texture",
         "float opacity_texel() { return 1.0; }",
         {{"alpha.glsl#opacity_texture", f.opacity_texture, {.samplers = {"opacity_texture"}}}}},
    };
}

/// Returns the step that rotates a direction into the environment map.
Step rotation_step(By f) {
    return {"environment_rotation",
            "vec3 direction_in_map(vec3 direction_world) { return direction_world; }",
            {{"environment.glsl#rotation",
              f.environment_rotation,
              {.uniforms = {"environment_turn"}}}}};
}

/// Returns the steps of the mirrored and refracted environment.
Steps reflection_steps(By f) {
    const bool none = f.reflection == ReflectionTerm::none;
    const bool phong = !none && !f.metallic_roughness;
    const bool mirrors = phong && looks_up_mirror(f);
    const auto fresnel = [&](FresnelTerm term) { return phong && f.fresnel == term; };
    return {
        rotation_step(f),
        {"reflection",
         "vec3 with_reflection(Surface surface, vec3 scattered) { return scattered; }",
         {{"reflection.glsl#refraction_only", none && f.refraction},
          {"reflection.glsl#metallic_roughness",
           !none && f.metallic_roughness,
           {.uniforms = {"environment_intensity", "blurred_levels"},
            .samplers = {"blurred_environment", "environment_brdf"}}},
          {"reflection.glsl#phong", mirrors},
          {"view.glsl#black_mirror_image", phong && !mirrors}}},
        {"reflected_direction",
         "vec3 reflected_direction(Surface surface) "
         "{ return reflect(-surface.view_world, surface.normal_world); }",
         {{"reflection.glsl#by_normal", f.reflection_by_normal}}},
        {"mirror_image",
         "",
         {{"reflection.glsl#mirror",
           mirrors && f.reflection == ReflectionTerm::mirror,
           {.uniforms = {"environment_intensity"}, .samplers = {"environment"}}},
          {"reflection.glsl#glossy",
           mirrors && f.reflection == ReflectionTerm::glossy,
           {.uniforms = {"environment_intensity", "blurred_levels", "reflection_roughness"},
            .samplers = {"blurred_environment"}}}}},
        {"fresnel",
         "",
         {{"fresnel.glsl#constant", fresnel(FresnelTerm::constant), {.uniforms = {"reflectivity"}}},
          {"fresnel.glsl#schlick",
           fresnel(FresnelTerm::schlick),
           {.uniforms = {"reflectivity", "grazing_reflectivity"}}},
          {"fresnel.glsl#dielectric",
           fresnel(FresnelTerm::dielectric),
           {.uniforms = {"reflectivity", "refractive_index"}}},
          {"fresnel.glsl#conductor",
           fresnel(FresnelTerm::conductor),
           {.uniforms = {"reflectivity", "conductor_index", "conductor_absorption"}}}}},
        {"refraction",
         "vec3 with_refraction(Surface surface, vec3 scattered) { return scattered; }",
         {{"refraction.glsl#dimming",
           f.refraction && !looks_up_refraction(f),
           {.uniforms = {"transmission"}}},
          {"refraction.glsl#refracted",
           looks_up_refraction(f),
           {.uniforms = {"environment_intensity", "transmission", "refraction_ratio"},
            .samplers = {"environment"}}}}},
    };
}

/// Returns the step of the color of a view of data.
Step view_step(By f) {
    const auto is = [&](DebugView view) { return f.view == view; };
    const bool object_map =
        is(DebugView::normal_map) && f.detail == NormalDetail::object_normal_map;
    return {
        "view",
        "",
        {{"view.glsl#normal", shows_normal(f)},
         {"view.glsl#tangent", is(DebugView::tangent)},
         {"view.glsl#bitangent", is(DebugView::bitangent)},
         {"view.glsl#handedness", is(DebugView::handedness)},
         {"view.glsl#texcoords", is(DebugView::texcoords)},
         {"view.glsl#normal_map", is(DebugView::normal_map) && !object_map},
         {"view.glsl#object_normal_map",
          object_map,
          {.uniforms = {"normal_map_scale", "normal_map_bias"}, .samplers = {"normal_texture"}}},
         {"view.glsl#height", is(DebugView::height), {.samplers = {"bump_texture"}}},
         {"view.glsl#overdraw", is(DebugView::overdraw)},
         {"view.glsl#hatched", is(DebugView::nothing_to_show)}}};
}

/// Returns the steps of the coding of the picture.
Steps coding_steps(By f) {
    return {
        {"output",
         "",
         {{"output.glsl#linear", f.output == OutputCoding::linear},
          {"output.glsl#half", f.output == OutputCoding::half},
          {"output.glsl#clamped", f.output == OutputCoding::clamped},
          {"output.glsl#srgb", f.output == OutputCoding::srgb}}},
        {"exposure",
         "vec3 exposed(vec3 radiance) { return radiance; }",
         {{"tone.glsl#exposure", f.exposure, {.uniforms = {"exposure"}}}}},
        {"tone",
         "vec3 toned(vec3 radiance) { return radiance; }",
         {{"tone.glsl#reinhard", f.tone_mapping == ToneMapping::reinhard},
          {"tone.glsl#aces", f.tone_mapping == ToneMapping::aces},
          {"tone.glsl#khronos_neutral", f.tone_mapping == ToneMapping::khronos_neutral},
          {"tone.glsl#aces_hill", f.tone_mapping == ToneMapping::aces_hill},
          {"tone.glsl#aces_hill_boost", f.tone_mapping == ToneMapping::aces_hill_boost}}},
    };
}

Steps joined(std::initializer_list<Steps> lists) {
    Steps all;
    for (const Steps& steps : lists)
        all.insert(all.end(), steps.begin(), steps.end());
    return all;
}

/// Returns the steps of the vertex stage: attributes, and with Gouraud shading the lights.
Steps vertex_steps(By f) {
    const Needs needs = vertex_needs(f);
    const Steps always =
        joined({{{"stage",
                  "",
                  {{"surface.vert.glsl",
                    true,
                    {.attributes = {"position_object"}, .uniforms = {"clip_from_object"}}}}},
                 {"pass_lights",
                  "void pass_lights() {}",
                  {{"gouraud.glsl#lights", needs.lights && !f.double_sided},
                   {"gouraud.glsl#lights_both_sides", needs.lights && f.double_sided}}}},
                deformation_steps(f),
                passing_steps(f)});
    if (!needs.lights) return always;
    return joined({always,
                   {{"position", "// pass_position() has written position_world.", {}},
                    {"shadow_place", "// pass_shadow() has written shadow_place.", {}},
                    {"normal", "", {{"gouraud.glsl#normal", true}}},
                    {"sharpness", neutral_sharpness, {}},
                    term_step(f, true),
                    surface_step(f, needs)},
                   light_steps(f, true),
                   scattering_steps(f, true)});
}

/// Returns the steps of the fragment stage of a lit surface.
Steps lit_steps(By f) {
    const bool lights_here = !is_gouraud(f) && has_lights(f);
    const bool both_sides = is_gouraud(f) && f.double_sided;
    return joined({{{"stage", "", {{"surface.frag.glsl", true}}},
                    second_texcoord_step(f),
                    {"lights",
                     "void add_lights(Surface surface, inout Lighting lighting) {}",
                     {{"light.glsl#all", lights_here},
                      {"gouraud.glsl#interpolated", is_gouraud(f) && !both_sides},
                      {"gouraud.glsl#interpolated_both_sides", both_sides}}},
                    {"shadow_place", "", {{"shadow.glsl#place", lights_here && has_shadow(f)}}},
                    term_step(f, lights_here || f.ambient || f.environment_diffuse || f.emission),
                    surface_step(f, fragment_needs(f))},
                   dielectric_steps(f),
                   energy_steps(f, lights_here),
                   film_steps(f),
                   facet_steps(f, lights_here),
                   layer_steps(f),
                   transmission_steps(f),
                   normal_steps(f),
                   light_steps(f, lights_here),
                   scattering_steps(f, lights_here),
                   ambient_steps(f),
                   color_steps(f),
                   alpha_steps(f),
                   reflection_steps(f),
                   coding_steps(f)});
}

Steps fragment_steps(By f) {
    if (is_data(f.view)) {
        return joined(
            {{{"stage", "", {{"data.frag.glsl", true}}}, second_texcoord_step(f), view_step(f)},
             normal_steps(f),
             color_steps(f),
             alpha_steps(f)});
    }
    if (!f.unlit) return lit_steps(f);
    return joined({{{"stage", "", {{"unlit.frag.glsl", true, {.uniforms = {"diffuse_color"}}}}},
                    second_texcoord_step(f)},
                   color_steps(f),
                   alpha_steps(f),
                   coding_steps(f)});
}

/// Returns the chosen code of each step; steps without any are left out.
ShaderSteps chosen_of(const Steps& steps) {
    ShaderSteps chosen;
    for (const Step& step : steps) {
        StepCode code{{}, step.neutral};
        for (const Part& part : step.parts) {
            if (!part.chosen) continue;
            assert(code.part.empty() && "two parts for one step");
            code = {part.address, {}};
        }
        if (code != StepCode{}) chosen.emplace(step.name, code);
    }
    return chosen;
}

ShaderConstants light_constants(const Features& f) {
    const LightRowLayout layout = light_row_layout(f);
    const auto number = [](std::uint32_t value) { return static_cast<int>(value); };
    return {{"directional_light_count", number(f.directional_lights)},
            {"point_light_count", number(f.point_lights)},
            {"spot_light_count", number(f.spot_lights)},
            {"directional_light_rows", number(layout.directional_rows)},
            {"point_light_rows", number(layout.point_rows)},
            {"spot_light_rows", number(layout.spot_rows)},
            {"first_point_row", number(layout.first_point)},
            {"first_spot_row", number(layout.first_spot)},
            {"light_row_count", number(layout.count)}};
}

void append(std::vector<std::string>& names, const std::vector<std::string_view>& more) {
    names.insert(names.end(), more.begin(), more.end());
}

void sort_and_unite(std::vector<std::string>& names) {
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
}

/// Changes the lookups of the textures that use the second texture coordinates.
std::string at_second_texcoords(std::string text, By f) {
    for_each_sampled(f, [&](const SecondTexture& texture, bool is_second) {
        if (!is_second) return;
        const std::string lookup = fmt::format("texture({}, texcoord_surface", texture.sampler);
        const std::size_t place = text.find(lookup);
        assert(place != std::string::npos && text.find(lookup, place + 1) == std::string::npos);
        text.insert(place + lookup.size(), "_2");
    });
    return text;
}

ShaderListing listing_of(const Features& features) {
    const SurfaceProgram program = surface_program(features);
    ShaderListing listing;
    listing.features = features;
    listing.vertex = program.vertex.text;
    listing.fragment = program.fragment.text;
    listing.files = program.vertex.parts;
    listing.files.insert(listing.files.end(), program.fragment.parts.begin(),
                         program.fragment.parts.end());
    sort_and_unite(listing.files);
    return listing;
}

}  // namespace

ChosenSteps chosen_steps(const Features& features) {
    return {chosen_of(vertex_steps(features)), chosen_of(fragment_steps(features))};
}

ShaderSteps pose_steps(bool morphing, bool skinning) {
    Features features;
    features.morphing = morphing;
    features.skinning = skinning;
    return chosen_of(deformation_steps(features));
}

ShaderSteps output_steps(OutputCoding coding, const Scene& scene) {
    Features features;
    features.output = coding;
    features.exposure = scene.exposure != 1.0F;
    features.tone_mapping = scene.tone_mapping;
    return chosen_of(coding_steps(canonical(features)));
}

ShaderSteps skybox_steps(OutputCoding coding, const Scene& scene) {
    ShaderSteps steps = output_steps(coding, scene);
    Features features;
    features.environment_rotation = scene.environment && scene.environment->rotation != 0.0F;
    const bool blurs = scene.environment && scene.environment->skybox_blur > 0.0F;
    steps.merge(
        chosen_of({rotation_step(features),
                   {"sky", "", {{"skybox.glsl#sharp", !blurs}, {"skybox.glsl#blurred", blurs}}}}));
    return steps;
}

SurfaceProgram surface_program(const Features& features) {
    const ChosenSteps steps = chosen_steps(features);
    const ShaderConstants constants =
        light_count(features) > 0 ? light_constants(features) : ShaderConstants{};
    // The stage that computes the lights.
    const bool at_vertices = features.interpolation == Interpolation::gouraud;
    SurfaceProgram program{assemble(steps.vertex.at("stage").part, steps.vertex,
                                    at_vertices ? constants : ShaderConstants{}),
                           assemble(steps.fragment.at("stage").part, steps.fragment,
                                    at_vertices ? ShaderConstants{} : constants)};
    program.fragment.text = at_second_texcoords(std::move(program.fragment.text), features);
    return program;
}

PlannedInterface planned_interface(const Features& features) {
    PlannedInterface planned;
    for (const Step& step : joined({vertex_steps(features), fragment_steps(features)})) {
        for (const Part& part : step.parts) {
            if (!part.chosen) continue;
            append(planned.attributes, part.takes.attributes);
            append(planned.uniforms, part.takes.uniforms);
            append(planned.samplers, part.takes.samplers);
            append(planned.uniform_blocks, part.takes.blocks);
        }
    }
    sort_and_unite(planned.attributes);
    sort_and_unite(planned.uniforms);
    sort_and_unite(planned.samplers);
    sort_and_unite(planned.uniform_blocks);
    return planned;
}

std::vector<ShaderListing> shader_listings(const FramePlan& plan) {
    std::vector<ShaderListing> listings;
    std::map<Features, std::size_t> known;
    for (std::size_t i = 0; i < plan.draws.size(); ++i) {
        const Features& features = plan.draws[i].features;
        const auto [entry, is_new] = known.emplace(features, listings.size());
        if (is_new) listings.push_back(listing_of(features));
        listings[entry->second].draws.push_back(i);
    }
    return listings;
}

}  // namespace relief
