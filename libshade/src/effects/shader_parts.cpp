// SPDX-License-Identifier: Apache-2.0
// The table of shader parts: one row a file, with the step that it stands for, when it is chosen,
// and what it takes from outside (its own declarations and those of the files that it includes by
// name). For every Features value at most one row of each step applies in a stage. Pure.
// Tests: tests/shade/effects/surface_program_test.cpp.
#include "effects/shader_parts.h"

#include "effects/light_rows.h"
#include "effects/view_features.h"

namespace relief {

namespace {

/// For the table: what a part is chosen by.
using By = const Features&;

bool has_lamps(By f) {
    return lamp_count(f) > 0;
}
bool has_placed_lamps(By f) {
    return f.point_lights + f.spot_lights > 0;
}
bool is_gouraud(By f) {
    return f.interpolation == Interpolation::gouraud;
}
bool is_flat(By f) {
    return f.interpolation == Interpolation::flat;
}

/// What a stage asks of the surface.
struct Needs {
    bool lamps = false;
    bool normal = false;
    bool position = false;  ///< For lamps that have a place.
    bool view = false;      ///< For highlights and mirror images: position and eye.
};

/// \param lamps  the stage computes them  \param rest  and everything else that shows the normal
Needs needs_of(By f, bool lamps, bool rest) {
    const bool reflects = rest && (f.reflection != ReflectionTerm::none || f.refraction);
    const bool lit_around = rest && f.environment_diffuse;
    Needs needs;
    needs.lamps = lamps && has_lamps(f);
    needs.normal = needs.lamps || reflects || lit_around;
    needs.position = needs.lamps && has_placed_lamps(f);
    needs.view = (needs.lamps && f.specular != SpecularTerm::none) || reflects ||
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

/// Whether a tangent frame bends the normal, and which.
bool is_bent(By f) {
    const bool tangent_space =
        f.detail == NormalDetail::normal_map || f.detail == NormalDetail::bump_map;
    return tangent_space && fragment_needs(f).normal;
}
bool has_frame(By f) {
    return is_bent(f) || shows_frame(f);
}
bool has_stored_frame(By f) {
    return has_frame(f) && f.frame == TangentFrame::stored;
}
bool has_derived_frame(By f) {
    return has_frame(f) && f.frame == TangentFrame::derivatives;
}
/// Whether a map's vector in tangent space is asked for.
bool has_detail(By f, NormalDetail detail) {
    return f.detail == detail && (is_bent(f) || f.view == DebugView::normal_map);
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
    return f.diffuse_texture || f.specular_texture || f.metallic_roughness_texture ||
           f.occlusion_texture || f.opacity_texture || f.emission_texture ||
           f.detail != NormalDetail::none || has_derived_frame(f) || f.view == DebugView::texcoords;
}

/// Vertex attributes on their way.
Parts passing_parts(By f) {
    const bool framed = has_stored_frame(f);
    return {
        {"pass_position", "absent/pass_position.glsl", !passes_position(f)},
        {"pass_position",
         "vertex/position.glsl",
         passes_position(f),
         {.uniforms = {"world_from_object"}}},
        {"pass_normal", "absent/pass_normal.glsl", !passes_normal(f)},
        {"pass_normal",
         "vertex/normal.glsl",
         passes_normal(f) && !framed,
         {.attributes = {"normal_object"}, .uniforms = {"world_from_object_normal"}}},
        {"pass_normal",
         "vertex/tangent_frame.glsl",
         framed,
         {.attributes = {"normal_object", "tangent_object"},
          .uniforms = {"world_from_object_normal", "world_from_object_tangent", "handedness"}}},
        {"pass_texcoord", "absent/pass_texcoord.glsl", !passes_texcoord(f)},
        {"pass_texcoord", "vertex/texcoord.glsl", passes_texcoord(f), {.attributes = {"texcoord"}}},
        {"pass_color", "absent/pass_color.glsl", !f.vertex_colors},
        {"pass_color", "vertex/color.glsl", f.vertex_colors, {.attributes = {"color_linear"}}},
    };
}

/// What a stage knows of the surface at a point.
Parts surface_parts(By f, const Needs& needs) {
    const bool physical = f.metallic_roughness;
    const bool has_view = needs.view && !physical;
    const bool has_position = needs.position && !needs.view;
    const bool has_normal = needs.normal && !needs.position && !needs.view;
    return {
        {"surface", "surface/none.glsl", !needs.normal && !physical},
        {"surface", "surface/normal.glsl", has_normal},
        {"surface", "surface/position.glsl", has_position},
        {"surface", "surface/view.glsl", has_view, {.uniforms = {"eye_world"}}},
        {"surface",
         "surface/physical_colors.glsl",
         physical && !needs.normal,
         {.uniforms = {"base_color", "metallic"}}},
        {"surface",
         "surface/physical.glsl",
         physical && needs.normal,
         {.uniforms = {"eye_world", "base_color", "metallic", "roughness"}}},
    };
}

/// The normal at a fragment.
Parts normal_parts(By f) {
    const bool normal = fragment_needs(f).normal;
    const bool bent = is_bent(f);
    const bool object_map = normal && f.detail == NormalDetail::object_normal_map;
    const Takes texel{.uniforms = {"normal_map_scale", "normal_map_bias"},
                      .samplers = {"normal_texture"}};
    return {
        {"position", "common/position.glsl", true},
        {"normal", "normal/flat.glsl", normal && is_flat(f), {.uniforms = {"eye_world"}}},
        {"normal", "normal/interpolated.glsl",
         normal && !is_flat(f) && f.detail == NormalDetail::none},
        {"normal", "normal/bent.glsl", bent},
        {"normal",
         "normal/object_map.glsl",
         object_map,
         {.uniforms = {"normal_map_scale", "normal_map_bias", "world_from_object_normal"},
          .samplers = {"normal_texture"}}},
        {"detail", "detail/normal_map.glsl", has_detail(f, NormalDetail::normal_map), texel},
        {"detail",
         "detail/bump_map.glsl",
         has_detail(f, NormalDetail::bump_map),
         {.uniforms = {"bump_strength"}, .samplers = {"bump_texture"}}},
        {"frame", "frame/stored.glsl", has_stored_frame(f)},
        {"frame", "frame/derivatives.glsl", has_derived_frame(f)},
        {"facing", "normal/front.glsl", normal && !f.double_sided},
        {"facing", "normal/both_sides.glsl", normal && f.double_sided},
        {"sharpness", "absent/sharpness.glsl", !f.specular_antialiasing},
        {"sharpness",
         "sharpness/toksvig.glsl",
         f.specular_antialiasing,
         {.uniforms = {"normal_map_unscale", "normal_map_rounding"}}},
    };
}

/// Lamps of every kind, in the stage that computes them.
Parts lamp_parts(By f, bool in_this_stage) {
    const bool any = in_this_stage && has_lamps(f);
    const bool placed = in_this_stage && has_placed_lamps(f);
    const auto kind = [&](std::uint32_t count) { return any && count > 0; };
    return {
        {"light_rows", "light/rows_block.glsl", any && !f.lights_in_buffer, {.blocks = {"Lights"}}},
        {"light_rows",
         "light/rows_buffer.glsl",
         any && f.lights_in_buffer,
         {.samplers = {"light_buffer"}}},
        {"directional_lights", "absent/directional_lights.glsl",
         any && !kind(f.directional_lights)},
        {"directional_lights", "light/directional.glsl", kind(f.directional_lights)},
        {"point_lights", "absent/point_lights.glsl", any && !kind(f.point_lights)},
        {"point_lights", "light/point.glsl", kind(f.point_lights)},
        {"spot_lights", "absent/spot_lights.glsl", any && !kind(f.spot_lights)},
        {"spot_lights", "light/spot.glsl", kind(f.spot_lights)},
        {"highlight_row", "absent/highlight_row.glsl", any && !f.highlight_colors},
        {"highlight_row", "light/highlight_row.glsl", any && f.highlight_colors},
        {"distance_law", "light/inverse_square.glsl",
         placed && f.falloff == FalloffTerm::inverse_square},
        {"distance_law", "light/no_falloff.glsl", placed && f.falloff == FalloffTerm::none},
        {"distance_law", "light/mixed_falloff.glsl", placed && f.falloff == FalloffTerm::mixed},
        {"range", "absent/range.glsl", placed && !f.light_ranges},
        {"range", "light/range.glsl", placed && f.light_ranges},
    };
}

/// What the surface does with a lamp's light.
Parts scattering_parts(By f, bool in_this_stage) {
    const bool physical = in_this_stage && has_lamps(f) && f.metallic_roughness;
    const bool phong = in_this_stage && has_lamps(f) && !f.metallic_roughness;
    const Takes highlight{.uniforms = {"specular_color", "shininess"}};
    return {
        {"receive", "light/receive_physical.glsl", physical},
        {"receive", "light/receive.glsl", phong},
        {"diffuse", "absent/diffuse.glsl", phong && !f.diffuse},
        {"diffuse", "scatter/lambert.glsl", phong && f.diffuse, {.uniforms = {"diffuse_color"}}},
        {"specular", "absent/specular.glsl", phong && f.specular == SpecularTerm::none},
        {"specular", "scatter/phong.glsl", phong && f.specular == SpecularTerm::phong, highlight},
        {"specular", "scatter/blinn_phong.glsl", phong && f.specular == SpecularTerm::blinn_phong,
         highlight},
    };
}

/// Light from everywhere.
Parts surrounding_parts(By f) {
    const bool physical = f.metallic_roughness;
    return {
        {"ambient", "absent/ambient.glsl", !f.ambient},
        {"ambient",
         "light/ambient.glsl",
         f.ambient && !physical,
         {.uniforms = {"ambient_scattered"}}},
        {"ambient",
         "light/ambient_physical.glsl",
         f.ambient && physical,
         {.uniforms = {"ambient_scattered"}}},
        {"environment_light", "absent/environment_light.glsl", !f.environment_diffuse},
        {"environment_light",
         "light/environment.glsl",
         f.environment_diffuse && !physical,
         {.uniforms = {"diffuse_color", "irradiance_sh"}}},
        {"environment_light",
         "light/environment_physical.glsl",
         f.environment_diffuse && physical,
         {.uniforms = {"irradiance_sh"}, .samplers = {"environment_brdf"}}},
        {"occlusion", "absent/occlusion.glsl", !f.occlusion_texture},
        {"occlusion",
         "color/occlusion.glsl",
         f.occlusion_texture,
         {.uniforms = {"occlusion_strength"}, .samplers = {"occlusion_texture"}}},
    };
}

/// Textures and colours that multiply.
Parts color_parts(By f) {
    const bool physical = f.metallic_roughness;
    // glTF's lamps scatter and mirror at once; a view of one of the two blackens the other.
    const bool no_scattering = physical && f.view == DebugView::specular;
    const bool no_highlights = physical && f.view == DebugView::diffuse;
    return {
        {"tint", "color/tint.glsl", !physical},
        {"tint", "color/tint_physical.glsl", physical && !no_scattering},
        {"tint", "absent/scattering.glsl", no_scattering},
        {"diffuse_texture", "absent/diffuse_texture.glsl", !f.diffuse_texture},
        {"diffuse_texture",
         "color/texture.glsl",
         f.diffuse_texture,
         {.samplers = {"diffuse_texture"}}},
        {"vertex_color", "absent/vertex_color.glsl", !f.vertex_colors},
        {"vertex_color", "color/vertex.glsl", f.vertex_colors},
        {"specular_texture", "absent/specular_texture.glsl", !f.specular_texture && !no_highlights},
        {"specular_texture", "absent/highlights.glsl", no_highlights},
        {"specular_texture",
         "color/specular_texture.glsl",
         f.specular_texture,
         {.samplers = {"specular_texture"}}},
        {"metallic_roughness", "color/metallic_roughness.glsl", !f.metallic_roughness_texture},
        {"metallic_roughness",
         "color/metallic_roughness_texture.glsl",
         f.metallic_roughness_texture,
         {.samplers = {"metallic_roughness_texture"}}},
        {"emission", "absent/emission.glsl", !f.emission},
        {"emission",
         "emission/color.glsl",
         f.emission && !f.emission_texture,
         {.uniforms = {"emission_color"}}},
        {"emission",
         "emission/texture.glsl",
         f.emission && f.emission_texture,
         {.uniforms = {"emission_color"}, .samplers = {"emission_texture"}}},
    };
}

Parts alpha_parts(By f) {
    return {
        {"alpha", "alpha/opaque.glsl", f.alpha == AlphaMode::opaque},
        {"alpha",
         "alpha/mask.glsl",
         f.alpha == AlphaMode::mask,
         {.uniforms = {"opacity", "alpha_cutoff"}}},
        {"alpha", "alpha/blend.glsl", f.alpha == AlphaMode::blend, {.uniforms = {"opacity"}}},
        {"opacity_texture", "absent/opacity_texture.glsl", !f.opacity_texture},
        {"opacity_texture",
         "alpha/opacity_texture.glsl",
         f.opacity_texture,
         {.samplers = {"opacity_texture"}}},
    };
}

/// The environment in the surface.
Parts reflection_parts(By f) {
    const bool none = f.reflection == ReflectionTerm::none;
    const bool physical = !none && f.metallic_roughness;
    const bool phong = !none && !f.metallic_roughness;
    const bool mirrors = phong && !has_black_mirror(f);
    const bool dims = f.refraction && has_black_transmission(f);
    return {
        {"mirror_image", "absent/mirror_image.glsl", phong && has_black_mirror(f)},
        {"refraction",
         "reflection/dimmed_by_refraction.glsl",
         dims,
         {.uniforms = {"transmission"}}},
        {"reflection", "absent/reflection.glsl", none && !f.refraction},
        {"reflection", "reflection/transparent.glsl", none && f.refraction},
        {"reflection",
         "reflection/physical.glsl",
         physical,
         {.uniforms = {"environment_intensity", "blurred_levels"},
          .samplers = {"blurred_environment", "environment_brdf"}}},
        {"reflection", "reflection/mirrored.glsl", phong},
        {"mirror_image",
         "reflection/mirror.glsl",
         mirrors && f.reflection == ReflectionTerm::mirror,
         {.uniforms = {"environment_intensity"}, .samplers = {"environment"}}},
        {"mirror_image",
         "reflection/glossy.glsl",
         mirrors && f.reflection == ReflectionTerm::glossy,
         {.uniforms = {"environment_intensity", "blurred_levels", "reflection_roughness"},
          .samplers = {"blurred_environment"}}},
        {"fresnel",
         "fresnel/constant.glsl",
         phong && f.fresnel == FresnelTerm::constant,
         {.uniforms = {"reflectivity"}}},
        {"fresnel",
         "fresnel/schlick.glsl",
         phong && f.fresnel == FresnelTerm::schlick,
         {.uniforms = {"reflectivity", "grazing_reflectivity"}}},
        {"fresnel",
         "fresnel/dielectric.glsl",
         phong && f.fresnel == FresnelTerm::dielectric,
         {.uniforms = {"reflectivity", "refractive_index"}}},
        {"fresnel",
         "fresnel/conductor.glsl",
         phong && f.fresnel == FresnelTerm::conductor,
         {.uniforms = {"reflectivity", "conductor_index", "conductor_absorption"}}},
        {"refraction", "absent/refraction.glsl", phong && !f.refraction},
        {"refraction",
         "reflection/refraction.glsl",
         f.refraction && !dims,
         {.uniforms = {"environment_intensity", "transmission", "refraction_ratio"},
          .samplers = {"environment"}}},
    };
}

/// What a view of data writes.
Parts view_parts(By f) {
    const auto is = [&](DebugView view) { return f.view == view; };
    const bool object_map =
        is(DebugView::normal_map) && f.detail == NormalDetail::object_normal_map;
    return {
        {"view", "view/normal.glsl", shows_normal(f)},
        {"view", "view/tangent.glsl", is(DebugView::tangent)},
        {"view", "view/bitangent.glsl", is(DebugView::bitangent)},
        {"view", "view/handedness.glsl", is(DebugView::handedness)},
        {"view", "view/texcoords.glsl", is(DebugView::texcoords)},
        {"view", "view/normal_map.glsl", is(DebugView::normal_map) && !object_map},
        {"view",
         "view/object_normal_map.glsl",
         object_map,
         {.uniforms = {"normal_map_scale", "normal_map_bias"}, .samplers = {"normal_texture"}}},
        {"view", "view/height.glsl", is(DebugView::height), {.samplers = {"bump_texture"}}},
        {"view", "view/overdraw.glsl", is(DebugView::overdraw)},
        {"view", "view/hatched.glsl", is(DebugView::nothing_to_show)},
    };
}

}  // namespace

Parts output_parts(const Features& f) {
    return {
        {"output", "output/linear.glsl", f.output == OutputCoding::linear},
        {"output", "output/half.glsl", f.output == OutputCoding::half},
        {"output", "output/clamped.glsl", f.output == OutputCoding::clamped},
        {"output", "output/srgb.glsl", f.output == OutputCoding::srgb},
        {"exposure", "absent/exposure.glsl", !f.exposure},
        {"exposure", "tone/exposure.glsl", f.exposure, {.uniforms = {"exposure"}}},
        {"tone", "absent/tone.glsl", f.tone_mapping == ToneMapping::none},
        {"tone", "tone/reinhard.glsl", f.tone_mapping == ToneMapping::reinhard},
        {"tone", "tone/aces.glsl", f.tone_mapping == ToneMapping::aces},
    };
}

std::vector<Parts> vertex_parts(const Features& f) {
    const Needs needs = vertex_needs(f);
    std::vector<Parts> parts{
        {{"stage",
          "surface.vert.glsl",
          true,
          {.attributes = {"position_object"}, .uniforms = {"clip_from_object"}}},
         {"pass_lamps", "absent/pass_lamps.glsl", !needs.lamps},
         {"pass_lamps", "gouraud/lamps.glsl", needs.lamps && !f.double_sided},
         {"pass_lamps", "gouraud/lamps_both_sides.glsl", needs.lamps && f.double_sided}},
        passing_parts(f)};
    if (!needs.lamps) return parts;
    parts.push_back({{"position", "gouraud/position.glsl", true},
                     {"normal", "gouraud/normal.glsl", true},
                     {"sharpness", "absent/sharpness.glsl", true}});
    parts.push_back(surface_parts(f, needs));
    parts.push_back(lamp_parts(f, true));
    parts.push_back(scattering_parts(f, true));
    return parts;
}

std::vector<Parts> fragment_parts(const Features& f) {
    const bool lamps_here = !is_gouraud(f) && has_lamps(f);
    const bool both_sides = is_gouraud(f) && f.double_sided;
    return {{{"stage", "surface.frag.glsl", true},
             {"lamps", "absent/lamps.glsl", !has_lamps(f)},
             {"lamps", "light/lamps.glsl", lamps_here},
             {"lamps", "gouraud/interpolated.glsl", is_gouraud(f) && !both_sides},
             {"lamps", "gouraud/interpolated_both_sides.glsl", both_sides}},
            surface_parts(f, fragment_needs(f)),
            normal_parts(f),
            lamp_parts(f, lamps_here),
            scattering_parts(f, lamps_here),
            surrounding_parts(f),
            color_parts(f),
            alpha_parts(f),
            reflection_parts(f),
            output_parts(f)};
}

std::vector<Parts> data_parts(const Features& f) {
    return {{{"stage", "data.frag.glsl", true}},
            view_parts(f),
            normal_parts(f),
            color_parts(f),
            alpha_parts(f)};
}

std::vector<Parts> unlit_parts(const Features& f) {
    return {{{"stage", "unlit.frag.glsl", true, {.uniforms = {"diffuse_color"}}}},
            color_parts(f),
            alpha_parts(f),
            output_parts(f)};
}

}  // namespace relief
