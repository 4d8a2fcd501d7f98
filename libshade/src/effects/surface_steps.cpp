// SPDX-License-Identifier: Apache-2.0
// The table of shader parts: the condition of every part that implements a step, unless one effect
// alone chooses it (EffectRow::part). At most one part of a step is chosen for any Features value.
// Pure. Tests: tests/shade/effects/shader_source_test.cpp.
#include <initializer_list>

#include "effects/features.h"
#include "effects/shader_source.h"
#include "relief/shade/effects.h"

namespace relief::shade::detail {

namespace {

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
           has_derived_frame(f) || is_displaced(f) || (here.normal && is_flat(f));
}
bool passes_normal(By f) {
    return has_frame(f) || is_displaced(f) || vertex_needs(f).normal ||
           (fragment_needs(f).normal && !is_flat(f));
}
bool passes_texcoord(By f) {
    bool is_looked_up = false;
    for_each_sampled(f,
                     [&](const TextureSlotInfo&, bool is_second) { is_looked_up |= !is_second; });
    return is_looked_up || is_displaced(f) || f.detail != NormalDetail::none ||
           has_derived_frame(f) || f.clearcoat_normal_map || f.anisotropy_texture ||
           f.view == DebugView::texcoords;
}

/// A part, and whether these features choose it for its step.
struct Choice {
    std::string_view part;
    bool is_chosen;
};

void choose(ShaderSteps& steps, std::initializer_list<Choice> choices) {
    for (const Choice& choice : choices) {
        if (choice.is_chosen) choose_part(steps, choice.part);
    }
}

/// Chooses the deformation of the mesh, in the vertex stage.
void choose_deformation(ShaderSteps& steps, By f) {
    const bool normal = passes_normal(f) && is_deformed(f);
    choose(steps, {{"vertex.glsl#morphing", f.morphing},
                   {"vertex.glsl#skinning", f.skinning},
                   {"vertex.glsl#skinned_directions", f.skinning && normal},
                   {"vertex.glsl#deformed_normal", normal && !f.deformed_facets},
                   {"vertex.glsl#facet_normal", normal && f.deformed_facets},
                   {"vertex.glsl#deformed_tangent", has_stored_frame(f) && is_deformed(f)}});
}

/// Chooses the vertex attributes that pass to the fragment stage.
void choose_passing(ShaderSteps& steps, By f) {
    const bool framed = has_stored_frame(f);
    choose(steps, {{"vertex.glsl#position", passes_position(f)},
                   {"vertex.glsl#normal", passes_normal(f) && !framed},
                   {"vertex.glsl#normal_and_tangent", framed},
                   {"vertex.glsl#texcoord", passes_texcoord(f)},
                   {"vertex.glsl#texcoord_2", f.second_texcoords != 0},
                   {"vertex.glsl#color", f.vertex_colors},
                   {"ambient.glsl#pass_occlusion", f.vertex_occlusion},
                   {"shadow.glsl#pass", has_shadow(f)}});
}

/// Chooses the values of the surface at a point.
void choose_surface(ShaderSteps& steps, By f, const Needs& needs) {
    const bool physical = f.metallic_roughness && has_lit_base(f);
    choose(steps, {{"surface.glsl#none", !needs.normal && !physical},
                   {"surface.glsl#normal", needs.normal && !needs.position && !needs.view},
                   {"surface.glsl#position", needs.position && !needs.view},
                   {"surface.glsl#view", needs.view && !physical},
                   {"metallic_roughness.glsl#surface_colors", physical && !needs.normal},
                   {"metallic_roughness.glsl#surface", physical && needs.normal}});
}

/// Chooses the reflectance of glTF's dielectrics.
void choose_dielectric(ShaderSteps& steps, By f) {
    const bool by_angle = f.dielectric_reflectance && has_lit_facets(f);
    choose(steps, {{"metallic_roughness.glsl#dielectric", f.dielectric_reflectance},
                   {"metallic_roughness.glsl#grazing", by_angle}});
}

/// Chooses the light that bounces between glTF's facets. Canonical features have it only where it
/// shows.
void choose_energy(ShaderSteps& steps, By f, bool lit_in_this_stage) {
    const bool kept = f.energy_compensation;
    const bool highlights = kept && lit_in_this_stage && f.view != DebugView::diffuse;
    const bool reflection = kept && f.reflection != ReflectionTerm::none;
    choose(steps, {{"energy_compensation.glsl#highlights", highlights},
                   {"energy_compensation.glsl#lobe_albedo", highlights && !f.anisotropy},
                   {"anisotropy.glsl#albedo", highlights && f.anisotropy},
                   {"energy_compensation.glsl#coat_highlights", highlights && f.clearcoat},
                   {"energy_compensation.glsl#coat_reflection", reflection && f.clearcoat},
                   {"energy_compensation.glsl#scattering", kept && f.environment_diffuse},
                   {"energy_compensation.glsl#reflection", reflection}});
}

/// Chooses the thin film on glTF's facets.
void choose_film(ShaderSteps& steps, By f) {
    choose(steps, {{"iridescence.glsl#film", f.iridescence},
                   {"iridescence.glsl#thickness", f.iridescence && !f.film_thickness_texture}});
}

/// Chooses what shows through glTF's surfaces.
void choose_transmission(ShaderSteps& steps, By f) {
    choose(steps, {{"refraction.glsl#transmission_dimming", f.transmission && !transmits(f)},
                   {"refraction.glsl#transmission", transmits(f)},
                   {"refraction.glsl#thin", transmits(f) && !f.volume},
                   {"refraction.glsl#volume", f.volume}});
}

/// Chooses glTF's facets. Canonical features have anisotropy only where it shows.
void choose_facets(ShaderSteps& steps, By f, bool in_this_stage) {
    const bool lit = in_this_stage && has_lights(f) && f.metallic_roughness;
    const bool mirrors = f.anisotropy && f.reflection != ReflectionTerm::none;
    choose(steps, {{"metallic_roughness.glsl#lobe", lit && !f.anisotropy},
                   {"anisotropy.glsl#lobe", lit && f.anisotropy},
                   {"anisotropy.glsl#mirror_normal", mirrors}});
}

/// Chooses the layers on glTF's surfaces. A view of one term has the layers' share of that term;
/// their highlights belong to highlights.
void choose_layers(ShaderSteps& steps, By f) {
    const bool highlights = has_lights(f) && f.view != DebugView::diffuse;
    const bool mirrors = f.clearcoat && f.reflection != ReflectionTerm::none;
    const bool smooth_sheen = f.sheen && !f.sheen_roughness_texture;
    choose(steps, {{"sheen.glsl#layer", f.sheen},
                   {"sheen.glsl#albedo", smooth_sheen},
                   {"sheen.glsl#lights", f.sheen && highlights},
                   {"sheen.glsl#width", smooth_sheen && highlights},
                   {"sheen.glsl#width_by_texture", f.sheen_roughness_texture && highlights},
                   {"sheen.glsl#ambient", f.sheen && f.ambient},
                   {"sheen.glsl#environment", f.sheen && f.environment_diffuse},
                   {"clearcoat.glsl#layer", f.clearcoat},
                   {"clearcoat.glsl#normal",
                    f.clearcoat && !f.clearcoat_normal_map && f.detail != NormalDetail::none},
                   {"clearcoat.glsl#lights", f.clearcoat && highlights},
                   {"clearcoat.glsl#ambient", f.clearcoat && f.ambient},
                   {"clearcoat.glsl#reflection", mirrors}});
}

/// Chooses the normal at a fragment.
void choose_normal(ShaderSteps& steps, By f) {
    const bool normal = fragment_needs(f).normal;
    choose(steps,
           {{"normal.glsl#flat", normal && is_flat(f)},
            {"normal.glsl#interpolated", normal && !is_flat(f) && f.detail == NormalDetail::none},
            {"normal.glsl#perturbed", is_perturbed(f)},
            {"normal_map.glsl#object_space", normal && f.detail == NormalDetail::object_normal_map},
            {"normal_map.glsl#tangent_space", has_detail(f, NormalDetail::normal_map)},
            {"bump_map.glsl#heights", has_detail(f, NormalDetail::bump_map)},
            {"bump_map.glsl#displaced", has_detail(f, NormalDetail::bump_map) && is_displaced(f)},
            {"tangent_frame.glsl#stored", has_stored_frame(f)},
            {"tangent_frame.glsl#derivatives", has_derived_frame(f)},
            {"normal.glsl#both_sides", normal && f.double_sided},
            {"specular_antialiasing.glsl#toksvig", f.specular_antialiasing}});
}

/// Chooses the displacement of texture coordinates by a relief.
void choose_displacement(ShaderSteps& steps, By f) {
    const auto uses = [&](DepthMapping method) { return f.depth_mapping == method; };
    const bool mipmaps = uses(DepthMapping::maximum_mipmaps);
    const bool walks = mipmaps || f.self_shadow;
    const auto columns = [&](Wrap wrap) { return walks && f.height_wrap_u == wrap; };
    const auto rows = [&](Wrap wrap) { return walks && f.height_wrap_v == wrap; };
    const bool clips_u = f.clipped_relief && f.height_wrap_u == Wrap::clamp;
    const bool clips_v = f.clipped_relief && f.height_wrap_v == Wrap::clamp;
    choose(steps, {{"inputs.glsl#position", true},
                   {"height_march.glsl#displacement", is_displaced(f)},
                   {"height_march.glsl#second", is_displaced(f) && f.second_texcoords != 0},
                   {"height_march.glsl#parallax", uses(DepthMapping::parallax)},
                   {"height_march.glsl#parallax_occlusion", uses(DepthMapping::parallax_occlusion)},
                   {"height_march.glsl#relief_mapping", uses(DepthMapping::relief_mapping)},
                   {"height_march.glsl#relaxed_cones", uses(DepthMapping::relaxed_cones)},
                   {"height_march.glsl#maximum_mipmaps", mipmaps},
                   {"height_march.glsl#columns_repeated", columns(Wrap::repeat)},
                   {"height_march.glsl#columns_clamped", columns(Wrap::clamp)},
                   {"height_march.glsl#columns_mirrored", columns(Wrap::mirror)},
                   {"height_march.glsl#rows_repeated", rows(Wrap::repeat)},
                   {"height_march.glsl#rows_clamped", rows(Wrap::clamp)},
                   {"height_march.glsl#rows_mirrored", rows(Wrap::mirror)},
                   {"height_curve.glsl#curved", f.curved_relief},
                   {"height_edge.glsl#curved", f.curved_relief && !clips_u && !clips_v},
                   {"height_edge.glsl#clip_both", clips_u && clips_v},
                   {"height_edge.glsl#clip_u", clips_u && !clips_v},
                   {"height_edge.glsl#clip_v", clips_v && !clips_u},
                   {"height_edge.glsl#written", f.written_depth}});
}

/// Chooses lights of every kind, in the stage that computes them.
void choose_lights(ShaderSteps& steps, By f, bool in_this_stage) {
    if (!in_this_stage || !has_lights(f)) return;
    const bool positional = has_positional_lights(f);
    choose(steps,
           {{"light.glsl#rows_block", !f.lights_in_buffer},
            {"light.glsl#rows_buffer", f.lights_in_buffer},
            {"light.glsl#directional", f.directional_lights > 0},
            {"light.glsl#point", f.point_lights > 0},
            {"light.glsl#spot", f.spot_lights > 0},
            {"light.glsl#highlight_row", f.highlight_colors},
            {"falloff.glsl#inverse_square", positional && f.falloff == FalloffTerm::inverse_square},
            {"falloff.glsl#none", positional && f.falloff == FalloffTerm::none},
            {"falloff.glsl#mixed", positional && f.falloff == FalloffTerm::mixed},
            {"falloff.glsl#range", positional && f.light_ranges},
            {"height_shadow.glsl#share", f.self_shadow},
            {"shadow.glsl#directional", f.shadow == ShadowTerm::directional_light},
            {"shadow.glsl#point", f.shadow == ShadowTerm::point_light},
            {"shadow.glsl#spot", f.shadow == ShadowTerm::spot_light}});
}

/// Chooses the surface's response to a light, in the stage that computes the lights.
void choose_scattering(ShaderSteps& steps, By f, bool in_this_stage) {
    if (!in_this_stage || !has_lights(f)) return;
    const bool phong = !f.metallic_roughness;
    const bool highlights = phong && f.specular != SpecularTerm::none;
    choose(steps, {{"metallic_roughness.glsl#receive", f.metallic_roughness},
                   {"phong.glsl#receive", phong},
                   {"phong.glsl#lambert", phong && f.diffuse},
                   {"phong.glsl#phong", phong && f.specular == SpecularTerm::phong},
                   {"phong.glsl#blinn_phong", phong && f.specular == SpecularTerm::blinn_phong},
                   {"phong.glsl#color", highlights && !f.highlight_fresnel},
                   {"phong.glsl#fresnel_color", highlights && f.highlight_fresnel}});
}

/// Chooses ambient light and the environment's light.
void choose_ambient(ShaderSteps& steps, By f) {
    const bool physical = f.metallic_roughness;
    choose(steps, {{"ambient.glsl#phong", f.ambient && !physical},
                   {"ambient.glsl#metallic_roughness", f.ambient && physical},
                   {"environment.glsl#light_phong", f.environment_diffuse && !physical},
                   {"environment.glsl#light_metallic_roughness", f.environment_diffuse && physical},
                   {"ambient.glsl#occlusion", f.occlusion_texture},
                   {"ambient.glsl#occlusion_by_vertex", f.vertex_occlusion && !f.occlusion_texture},
                   {"ambient.glsl#open_share", f.vertex_occlusion}});
}

/// Chooses textures and colors that multiply.
void choose_colors(ShaderSteps& steps, By f) {
    const bool physical = f.metallic_roughness && has_lit_base(f);
    // Lights of glTF's model scatter and mirror at once; a view of one of the two blackens the
    // other.
    const bool black_scattering = physical && f.view == DebugView::specular;
    const bool black_highlights = physical && f.view == DebugView::diffuse;
    choose(steps, {{"color.glsl#tint", !physical},
                   {"metallic_roughness.glsl#tint", physical && !black_scattering},
                   {"view.glsl#no_scattering", black_scattering},
                   {"color.glsl#diffuse_texture", f.diffuse_texture},
                   {"color.glsl#environment_tint", f.environment_tint},
                   {"color.glsl#vertex", f.vertex_colors},
                   {"view.glsl#no_highlights", black_highlights},
                   {"color.glsl#specular_texture", f.specular_texture},
                   {"metallic_roughness.glsl#factors", physical && !f.metallic_roughness_texture},
                   {"metallic_roughness.glsl#texture", f.metallic_roughness_texture},
                   {"metallic_roughness.glsl#roughness", f.metallic_roughness && has_lit_facets(f)},
                   {"emission.glsl#color", f.emission && !f.emission_texture},
                   {"emission.glsl#texture", f.emission && f.emission_texture}});
}

/// Chooses the parts of the effects that choose one part alone.
void choose_own_parts(ShaderSteps& steps, By f) {
    for (const EffectRow& row : effect_rows()) {
        const std::string_view part = row.part;
        if (!part.empty() && row.effect.on(f)) choose_part(steps, part);
    }
}

/// Chooses coverage, and the second texture coordinates, at which at_second_texcoords() looks up.
void choose_alpha(ShaderSteps& steps, By f) {
    choose(steps, {{"alpha.glsl#mask", f.alpha == AlphaMode::mask},
                   {"alpha.glsl#blend", f.alpha == AlphaMode::blend},
                   {"alpha.glsl#opacity_texture", f.opacity_texture},
                   {"inputs.glsl#texcoord_2", f.second_texcoords != 0}});
}

/// Chooses the mirrored and refracted environment.
void choose_reflection(ShaderSteps& steps, By f) {
    const bool none = f.reflection == ReflectionTerm::none;
    const bool phong = !none && !f.metallic_roughness;
    const bool mirrors = phong && looks_up_mirror(f);
    const auto fresnel = [&](FresnelTerm term) { return phong && f.fresnel == term; };
    choose(steps, {{"environment.glsl#rotation", f.environment_rotation},
                   {"reflection.glsl#refraction_only", none && f.refraction},
                   {"reflection.glsl#metallic_roughness", !none && f.metallic_roughness},
                   {"reflection.glsl#phong", mirrors},
                   {"view.glsl#black_mirror_image", phong && !mirrors},
                   {"reflection.glsl#by_normal", f.reflection_by_normal},
                   {"reflection.glsl#mirror", mirrors && f.reflection == ReflectionTerm::mirror},
                   {"reflection.glsl#glossy", mirrors && f.reflection == ReflectionTerm::glossy},
                   {"fresnel.glsl#constant", fresnel(FresnelTerm::constant)},
                   {"fresnel.glsl#schlick", fresnel(FresnelTerm::schlick)},
                   {"fresnel.glsl#dielectric", fresnel(FresnelTerm::dielectric)},
                   {"fresnel.glsl#conductor", fresnel(FresnelTerm::conductor)},
                   {"refraction.glsl#dimming", f.refraction && !looks_up_refraction(f)},
                   {"refraction.glsl#refracted", looks_up_refraction(f)}});
}

/// Chooses the color of a view of data.
void choose_view(ShaderSteps& steps, By f) {
    const auto is = [&](DebugView view) { return f.view == view; };
    const bool object_map = f.detail == NormalDetail::object_normal_map;
    choose(steps, {{"view.glsl#normal", shows_normal(f)},
                   {"view.glsl#tangent", is(DebugView::tangent)},
                   {"view.glsl#bitangent", is(DebugView::bitangent)},
                   {"view.glsl#handedness", is(DebugView::handedness)},
                   {"view.glsl#texcoords", is(DebugView::texcoords)},
                   {"view.glsl#normal_map", is(DebugView::normal_map) && !object_map},
                   {"view.glsl#object_normal_map", is(DebugView::normal_map) && object_map},
                   {"view.glsl#height", is(DebugView::height)},
                   {"view.glsl#overdraw", is(DebugView::overdraw)},
                   {"view.glsl#hatched", is(DebugView::nothing_to_show)}});
}

/// Chooses the coding of the picture.
void choose_coding(ShaderSteps& steps, By f) {
    choose(steps, {{"output.glsl#linear", f.output == OutputCoding::linear},
                   {"output.glsl#half", f.output == OutputCoding::half},
                   {"output.glsl#clamped", f.output == OutputCoding::clamped},
                   {"output.glsl#srgb", f.output == OutputCoding::srgb},
                   {"tone.glsl#exposure", f.exposure},
                   {"tone.glsl#reinhard", f.tone_mapping == ToneMapping::reinhard},
                   {"tone.glsl#aces", f.tone_mapping == ToneMapping::aces},
                   {"tone.glsl#khronos_neutral", f.tone_mapping == ToneMapping::khronos_neutral},
                   {"tone.glsl#aces_hill", f.tone_mapping == ToneMapping::aces_hill},
                   {"tone.glsl#aces_hill_boost", f.tone_mapping == ToneMapping::aces_hill_boost}});
}

/// Chooses the vertex stage: attributes, and with Gouraud shading the lights.
ShaderSteps vertex_steps(By f) {
    ShaderSteps steps;
    choose_deformation(steps, f);
    choose_passing(steps, f);
    const Needs needs = vertex_needs(f);
    if (!needs.lights) return steps;
    choose(steps, {{"gouraud.glsl#lights", !f.double_sided},
                   {"gouraud.glsl#lights_both_sides", f.double_sided},
                   {"gouraud.glsl#normal", true},
                   {"phong.glsl#clamped_terms", f.clamped_terms}});
    choose_surface(steps, f, needs);
    choose_lights(steps, f, true);
    choose_scattering(steps, f, true);
    return steps;
}

/// Chooses the fragment stage of a lit surface.
void choose_lit_surface(ShaderSteps& steps, By f) {
    const bool lights_here = !is_gouraud(f) && has_lights(f);
    const bool both_sides = is_gouraud(f) && f.double_sided;
    const bool adds_terms = lights_here || f.ambient || f.environment_diffuse || f.emission;
    choose(steps, {{"light.glsl#all", lights_here},
                   {"gouraud.glsl#interpolated", is_gouraud(f) && !both_sides},
                   {"gouraud.glsl#interpolated_both_sides", both_sides},
                   {"shadow.glsl#place", lights_here && has_shadow(f) && !f.displaced_shadow},
                   {"shadow.glsl#displaced_place", lights_here && f.displaced_shadow},
                   {"phong.glsl#clamped_terms", f.clamped_terms && adds_terms}});
    choose_surface(steps, f, fragment_needs(f));
    choose_dielectric(steps, f);
    choose_energy(steps, f, lights_here);
    choose_film(steps, f);
    choose_facets(steps, f, lights_here);
    choose_layers(steps, f);
    choose_transmission(steps, f);
    choose_normal(steps, f);
    choose_lights(steps, f, lights_here);
    choose_scattering(steps, f, lights_here);
    choose_ambient(steps, f);
    choose_reflection(steps, f);
    choose_own_parts(steps, f);
    choose_coding(steps, f);
}

}  // namespace

ChosenSteps chosen_steps(const Features& features) {
    ChosenSteps chosen;
    chosen.vertex = vertex_steps(features);
    ShaderSteps& steps = chosen.fragment;
    choose_colors(steps, features);
    choose_alpha(steps, features);
    choose_displacement(steps, features);
    if (is_data(features.view)) {
        chosen.fragment_main = "data.frag.glsl";
        choose_view(steps, features);
        choose_normal(steps, features);
    } else if (features.unlit) {
        chosen.fragment_main = "unlit.frag.glsl";
        choose_coding(steps, features);
    } else {
        chosen.fragment_main = "surface.frag.glsl";
        choose_lit_surface(steps, features);
    }
    return chosen;
}

ShaderSteps pose_steps(bool morphing, bool skinning) {
    Features features;
    features.morphing = morphing;
    features.skinning = skinning;
    ShaderSteps steps;
    choose_deformation(steps, features);
    return steps;
}

ShaderSteps output_steps(OutputCoding coding, const Scene& scene) {
    Features features;
    features.output = coding;
    features.exposure = scene.exposure != 1.0F;
    features.tone_mapping = scene.tone_mapping;
    ShaderSteps steps;
    choose_coding(steps, canonical(features));
    return steps;
}

ShaderSteps finishing_steps(OutputCoding coding, const Scene& scene, std::string_view samples) {
    ShaderSteps steps = output_steps(coding, scene);
    choose_part(steps, samples);
    return steps;
}

ShaderSteps skybox_steps(OutputCoding coding, const Scene& scene) {
    ShaderSteps steps = output_steps(coding, scene);
    const bool rotates = scene.environment && scene.environment->rotation != 0.0F;
    const bool blurs = scene.environment && scene.environment->skybox_blur > 0.0F;
    choose(steps, {{"environment.glsl#rotation", rotates},
                   {"skybox.glsl#sharp", !blurs},
                   {"skybox.glsl#blurred", blurs}});
    return steps;
}

}  // namespace relief::shade::detail
