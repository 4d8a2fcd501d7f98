// SPDX-License-Identifier: Apache-2.0
// canonical(): the rules that drop effects which cannot show, in pictures and in debug views. Also
// describes a set of effects in words. Pure.
// Tests: tests/shade/effects/effects_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

#include "effects/features.h"
#include "effects/light_rows.h"
#include "relief/shade/effects.h"

namespace relief::shade {
using namespace relief::shade::detail;

namespace {

/// An opaque surface ignores the opacity texture.
void drop_alpha(Features& f) {
    if (f.alpha == AlphaMode::opaque) f.opacity_texture = false;
}

/// Exposure and tone mapping belong to sRGB pictures.
void drop_tone(Features& f) {
    if (f.output == OutputCoding::srgb) return;
    f.tone_mapping = ToneMapping::none;
    f.exposure = false;
}

/// Displaced coordinates show where a texture is looked up, in shadows, silhouettes and depth.
/// Lights at vertices have no shadows. A relief is clipped along axes that do not repeat.
void drop_depth_mapping(Features& f) {
    const bool clamped = f.height_wrap_u == Wrap::clamp || f.height_wrap_v == Wrap::clamp;
    f.self_shadow &=
        is_displaced(f) && light_count(f) > 0 && f.interpolation != Interpolation::gouraud;
    f.clipped_relief &= is_displaced(f) && clamped;
    f.curved_relief &= is_displaced(f);
    f.written_depth &= is_displaced(f);
    f.displaced_shadow &= f.written_depth;
    if (!shows_displacement(f)) f.depth_mapping = DepthMapping::none;
    if (!has_height_wraps(f)) f.height_wrap_u = f.height_wrap_v = Wrap::repeat;
}

/// The displacement of what is looked up belongs to the surface.
void keep_depth_mapping(const Features& f, Features& kept) {
    kept.depth_mapping = f.depth_mapping;
    kept.height_wrap_u = f.height_wrap_u;
    kept.height_wrap_v = f.height_wrap_v;
    kept.clipped_relief = f.clipped_relief;
    kept.curved_relief = f.curved_relief;
    kept.written_depth = f.written_depth;
}

void drop_second_texcoords(Features& f) {
    std::uint32_t sampled = 0;
    for_each_second_bit(f, [&](const TextureSlotInfo&, std::uint32_t bit) { sampled |= bit; });
    f.second_texcoords &= sampled;
}

/// The deformation of the mesh is part of the surface's shape.
void keep_deformation(const Features& f, Features& kept) {
    kept.morphing = f.morphing;
    kept.skinning = f.skinning;
}

/// An unlit surface shows its tinted diffuse color and nothing else.
Features unlit_only(const Features& f) {
    Features result;
    result.unlit = true;
    keep_deformation(f, result);
    result.diffuse_texture = f.diffuse_texture;
    result.vertex_colors = f.vertex_colors;
    result.alpha = f.alpha;
    result.opacity_texture = f.opacity_texture;
    result.second_texcoords = f.second_texcoords;
    keep_depth_mapping(f, result);
    result.output = f.output;
    result.tone_mapping = f.tone_mapping;
    result.exposure = f.exposure;
    drop_alpha(result);
    drop_tone(result);
    drop_depth_mapping(result);
    drop_second_texcoords(result);
    return result;
}

/// glTF's model has one term for all lights, and reflects by its own Fresnel factor.
void settle_model(Features& f) {
    if (f.metallic_roughness) {
        f.specular = SpecularTerm::none;
        f.specular_texture = f.highlight_colors = f.refraction = false;
        f.fresnel = FresnelTerm::constant;
        if (f.reflection != ReflectionTerm::none) f.reflection = ReflectionTerm::glossy;
        if (f.interpolation == Interpolation::gouraud) f.interpolation = Interpolation::per_pixel;
    } else {
        f.metallic_roughness_texture = f.dielectric_reflectance = f.iridescence = false;
        f.transmission = f.energy_compensation = false;
    }
    if (f.reflection == ReflectionTerm::none) f.fresnel = FresnelTerm::constant;
}

void drop_lights(Features& f) {
    if (light_count(f) == 0) {
        f.diffuse = false;
        f.specular = SpecularTerm::none;
    }
    if (!f.diffuse && f.specular == SpecularTerm::none) {
        f.directional_lights = f.point_lights = f.spot_lights = 0;
    }
    if (f.point_lights + f.spot_lights == 0) {
        f.light_ranges = false;
        f.falloff = FalloffTerm::inverse_square;
    }
    if (f.specular == SpecularTerm::none)
        f.specular_texture = f.highlight_colors = f.highlight_fresnel = false;
    const std::uint32_t casting = f.shadow == ShadowTerm::directional_light ? f.directional_lights
                                  : f.shadow == ShadowTerm::spot_light      ? f.spot_lights
                                  : f.shadow == ShadowTerm::point_light     ? f.point_lights
                                                                            : 0;
    if (casting == 0) f.shadow = ShadowTerm::none;
    if (light_count(f) == 0) f.lights_in_buffer = false;
    if (light_row_layout(f).count > max_block_rows) f.lights_in_buffer = true;
    if (light_count(f) == 0 && f.interpolation == Interpolation::gouraud) {
        f.interpolation = Interpolation::per_pixel;
        f.detail = NormalDetail::none;  // As with lights.
    }
}

/// Phong's surfaces are tinted where they scatter light or have highlights, and clamp what they
/// add up.
void drop_phong_choices(Features& f) {
    const bool scatters =
        f.ambient || f.environment_diffuse || f.diffuse || f.specular != SpecularTerm::none;
    f.environment_tint &= !f.metallic_roughness && scatters;
    f.clamped_terms &= !f.metallic_roughness && (scatters || f.emission);
}

/// True if light of any kind reaches glTF's surface, apart from its emission.
bool is_lit_anyhow(const Features& f) {
    return light_count(f) > 0 || f.ambient || f.environment_diffuse ||
           f.reflection != ReflectionTerm::none || transmits(f);
}

/// Sheen and coat belong to glTF's model, and so does anisotropy, which stretches highlights and
/// mirror images. Sheen needs light; a coat also dims the emission.
void drop_layers(Features& f) {
    const bool highlights = light_count(f) > 0 && f.view != DebugView::diffuse;
    f.anisotropy &= f.metallic_roughness && (highlights || f.reflection != ReflectionTerm::none);
    f.energy_compensation &=
        highlights || f.reflection != ReflectionTerm::none || f.environment_diffuse;
    if (!f.metallic_roughness || !is_lit_anyhow(f)) f.sheen = false;
    if (!f.metallic_roughness || !(is_lit_anyhow(f) || f.emission)) f.clearcoat = false;
    f.clearcoat_roughness_texture &= highlights || f.reflection != ReflectionTerm::none;
    f.clearcoat_normal_map &= f.clearcoat && f.interpolation == Interpolation::per_pixel;
}

/// Rotation and direction show where the environment is looked up by direction. The light that it
/// scatters is rotated before.
void drop_lookups(Features& f) {
    f.environment_rotation &= looks_up_mirror(f) || looks_up_refraction(f) || f.environment_tint;
    f.reflection_by_normal &= looks_up_mirror(f) && !f.metallic_roughness;
}

void drop_normal(Features& f) {
    const bool per_pixel_lights = light_count(f) > 0 && f.interpolation != Interpolation::gouraud;
    const bool seen = per_pixel_lights || reflection_shows_normal(f) || f.environment_diffuse ||
                      f.sheen || transmits(f);
    // A coat shows the normal without its map.
    const bool plain_seen = seen || f.clearcoat;
    if (!seen) f.detail = NormalDetail::none;
    if (!plain_seen && f.interpolation == Interpolation::flat) {
        f.interpolation = Interpolation::per_pixel;
    }
    if (f.interpolation != Interpolation::per_pixel) f.detail = NormalDetail::none;
    // Gouraud shading has two sides as well; a triangle's plane turns to the eye by itself.
    if ((!plain_seen && light_count(f) == 0) || f.interpolation == Interpolation::flat) {
        f.double_sided = false;
    }
    if (!lies_in_frame(f)) f.frame = TangentFrame::stored;
    // Facets need a normal at the vertices; flat shading computes its own.
    const bool passed =
        (plain_seen || light_count(f) > 0) && f.interpolation != Interpolation::flat;
    f.deformed_facets &= is_deformed(f) && (passed || lies_in_frame(f));
    const bool mapped =
        f.detail == NormalDetail::normal_map || f.detail == NormalDetail::object_normal_map;
    const bool sharp =
        f.specular != SpecularTerm::none ||
        (f.metallic_roughness && (light_count(f) > 0 || f.reflection != ReflectionTerm::none));
    if (!mapped || !sharp) f.specular_antialiasing = false;
}

void drop_colors(Features& f) {
    const bool from_everywhere = f.ambient || f.environment_diffuse ||
                                 (f.metallic_roughness && f.reflection != ReflectionTerm::none);
    if (!from_everywhere) f.occlusion_texture = f.vertex_occlusion = false;
    if (!from_everywhere && !f.diffuse && !transmits(f)) {
        f.metallic_roughness &= f.clearcoat;
        f.metallic_roughness_texture = f.dielectric_reflectance = f.iridescence = false;
        if (f.alpha == AlphaMode::opaque) f.diffuse_texture = f.vertex_colors = false;
    }
    // In views of one term it needs scattered light to dim.
    f.transmission &= transmits(f) || f.ambient || f.environment_diffuse || light_count(f) > 0;
    f.volume &= transmits(f);
}

/// Drops the effects whose base is not there.
void drop_dependents(Features& f) {
    for (const EffectRow& row : effect_rows()) {
        if (row.base != nullptr && !(f.*row.base)) row.effect.set(f, false);
    }
}

std::string counted(std::uint32_t count, std::string_view kind) {
    return fmt::format("{} {} light{}", count, kind, count == 1 ? "" : "s");
}

/// The holes of a mask are part of the surface's shape; so is everything that multiplies alpha.
void keep_mask(const Features& f, Features& kept) {
    if (f.alpha != AlphaMode::mask) return;
    kept.alpha = f.alpha;
    kept.opacity_texture = f.opacity_texture;
    kept.diffuse_texture = f.diffuse_texture;
    kept.vertex_colors = f.vertex_colors;
    kept.second_texcoords = f.second_texcoords;
}

void keep_normal(const Features& f, Features& kept) {
    const bool is_flat = f.interpolation == Interpolation::flat;
    if (is_flat) kept.interpolation = f.interpolation;
    kept.double_sided = f.double_sided && !is_flat;
    kept.deformed_facets = f.deformed_facets && is_deformed(f) && !is_flat;
    if (f.interpolation != Interpolation::per_pixel) return;
    kept.detail = f.detail;
    if (f.detail == NormalDetail::normal_map || f.detail == NormalDetail::bump_map)
        kept.frame = f.frame;
}

/// Returns the effects that a view of data needs; nothing_to_show if the draw has no such data.
Features data_features(const Features& f) {
    Features kept;
    kept.view = f.view;
    kept.output = OutputCoding::linear;
    keep_deformation(f, kept);
    keep_mask(f, kept);
    // Shadow maps count fragments, too: the ray of view is then that of the light.
    kept.displaced_shadow =
        f.view == DebugView::overdraw && f.displaced_shadow && f.written_depth && is_displaced(f);
    if (f.view != DebugView::overdraw || kept.displaced_shadow) keep_depth_mapping(f, kept);
    switch (f.view) {
        case DebugView::geometric_normal:
            kept.interpolation = Interpolation::flat;
            break;
        case DebugView::shading_normal:
            keep_normal(f, kept);
            break;
        case DebugView::tangent:
        case DebugView::bitangent:
        case DebugView::handedness:
            kept.frame = f.frame;
            kept.deformed_facets = f.deformed_facets && is_deformed(f);
            break;
        case DebugView::normal_map:
            kept.detail = f.detail;
            if (f.detail == NormalDetail::none) kept.view = DebugView::nothing_to_show;
            break;
        case DebugView::height:
            kept.detail = NormalDetail::bump_map;
            if (f.detail != NormalDetail::bump_map) {
                kept.detail = NormalDetail::none;
                kept.view = DebugView::nothing_to_show;
            }
            break;
        default:
            break;
    }
    drop_depth_mapping(kept);
    drop_second_texcoords(kept);
    return kept;
}

/// Returns the effects that contribute to one term of the light; not canonical yet.
Features term_features(Features f) {
    const DebugView term = f.view;
    const bool is_lights = term == DebugView::diffuse || term == DebugView::specular;
    const bool is_scattered = term == DebugView::ambient || term == DebugView::diffuse ||
                              term == DebugView::environment_light;
    f.unlit = false;
    f.ambient &= term == DebugView::ambient;
    f.environment_diffuse &= term == DebugView::environment_light;
    f.emission &= term == DebugView::emission;
    if (!is_lights) f.directional_lights = f.point_lights = f.spot_lights = 0;
    if (!f.metallic_roughness) {
        f.diffuse &= term == DebugView::diffuse;
        if (term != DebugView::specular) f.specular = SpecularTerm::none;
    }
    // Reflection and refraction dim the scattered light of Phong's surfaces, and each other.
    const bool dims = is_scattered && !f.metallic_roughness;
    if (term != DebugView::reflection && term != DebugView::refraction && !dims)
        f.reflection = ReflectionTerm::none;
    if (term != DebugView::refraction && !dims) f.refraction = false;
    f.transmission &= is_scattered;
    return f;
}

}  // namespace

Features canonical(Features f) {
    if (is_data(f.view)) return data_features(f);
    if (is_term(f.view)) f = term_features(f);
    if (f.unlit) return unlit_only(f);
    settle_model(f);
    drop_lights(f);
    drop_phong_choices(f);
    drop_layers(f);
    drop_lookups(f);
    drop_normal(f);
    drop_colors(f);
    drop_dependents(f);
    drop_alpha(f);
    drop_tone(f);
    f.displaced_shadow &= f.shadow != ShadowTerm::none;
    drop_depth_mapping(f);
    drop_second_texcoords(f);
    return f;
}

Features detail::casting_features(Features f) {
    f.view = DebugView::overdraw;
    // Exact hits, so that the points that a method of the view meets are compared with the relief.
    if (f.displaced_shadow) f.depth_mapping = DepthMapping::maximum_mipmaps;
    return canonical(f);
}

bool detail::shows_displacement(const Features& f) {
    if (f.detail != NormalDetail::none || f.self_shadow || f.clipped_relief || f.curved_relief ||
        f.written_depth)
        return true;
    return std::any_of(slot_effects.begin(), slot_effects.end(), [&](const SlotEffect& sampling) {
        return sampling.effect != nullptr && f.*sampling.effect;
    });
}

std::string describe(const Features& f) {
    const std::map<std::string_view, std::uint32_t> lights = {
        {"directional", f.directional_lights}, {"point", f.point_lights}, {"spot", f.spot_lights}};
    std::vector<std::string> parts;
    for (const Effect& effect : effects()) {
        if (!effect.on(f)) continue;
        const std::string_view name = effect.name;
        const auto light = lights.find(name.substr(0, name.find(" light")));
        if (light == lights.end()) {
            parts.emplace_back(name);
        } else {
            parts.push_back(counted(light->second, light->first));
        }
    }
    for (std::size_t i = 0; i < texture_slot_count; ++i) {
        if ((f.second_texcoords >> i & 1U) != 0)
            parts.push_back(fmt::format("{} at second coordinates", texture_slots[i].sampler));
    }
    const auto add_wrap = [&](const char* axis, Wrap wrap) {
        if (wrap == Wrap::repeat) return;
        parts.push_back(
            fmt::format("{} {} heights", wrap == Wrap::clamp ? "clamped" : "mirrored", axis));
    };
    add_wrap("along u", f.height_wrap_u);
    add_wrap("along v", f.height_wrap_v);
    if (f.view != DebugView::picture)
        parts.push_back(fmt::format("view of {}", debug_view_info(f.view).name));
    constexpr std::array<const char*, 4> codings = {"linear", "clamped", "sRGB", "half"};
    parts.emplace_back(codings.at(static_cast<std::size_t>(f.output)));
    return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace relief::shade
