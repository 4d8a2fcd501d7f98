// SPDX-License-Identifier: Apache-2.0
// One row per effect: its name, its place in Features, the condition under which a scene calls for
// it, whether it is neutral when forced on, and why it may be hidden. An effect is left out only if
// its contribution is exactly zero. Pure.
// Tests: tests/shade/effects/effects_test.cpp, plan_test.cpp.
#include "effects/features.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "effects/light_rows.h"

namespace relief::shade {
using namespace relief::shade::detail;

namespace {

using Subject = const DrawSubject&;
using Forced = const ForcingSubject&;
using F = Features;

/// Returns the effect of the lights of one kind; switched on without any, there is one.
template <std::uint32_t Features::*Member>
Effect lights(const char* name) {
    return {name, [](const Features& f) { return f.*Member > 0; },
            [](Features& f, bool on) {
                if (!on) {
                    f.*Member = 0;
                } else if (f.*Member == 0) {
                    f.*Member = 1;
                }
            },
            "the material does not respond to light"};
}

// Reasons of canonical() that several rows share.
const char* const no_light =
    "no light reaches the surface, or its material does not respond to light";
const char* const no_layer = "the material is not metallic-roughness, or no light reaches it";
const char* const no_facets = "the material is not metallic-roughness, or reflects nothing";
const char* const no_normal = "neither light nor reflection shows the normal";
const char* const no_color = "there is no scattered light to tint";
const char* const no_highlights = "there are no highlights";
const char* const not_lit = "no light source reaches the surface";
const char* const not_reflecting = "nothing is reflected";
const char* const not_srgb = "the picture is not coded in sRGB";

const char* const not_deformed = "the mesh is not deformed, or its normals are not used";

const char* map_hidden_by(const Features& requested, const Features& shown) {
    if (requested.detail == shown.detail) return "";
    switch (requested.interpolation) {
        case Interpolation::gouraud:
            return "Gouraud shading uses normals only at vertices";
        case Interpolation::flat:
            return "flat shading uses only the triangle's normal";
        default:
            return "";
    }
}

const char* sides_hidden_by(const Features& requested, const Features& /*shown*/) {
    const bool flat = requested.interpolation == Interpolation::flat;
    return flat ? "a triangle's plane turns to the eye by itself" : "";
}

const char* finishing_hidden_by(const Features& requested, const Features& /*shown*/) {
    return requested.output == OutputCoding::half ? "the finishing pass does it" : "";
}

// Conditions under which a choice is neutral.
bool has_no_map(Forced s) {
    return s.planned.detail == NormalDetail::none;
}
bool has_no_positional_lights(Forced s) {
    return s.planned.point_lights + s.planned.spot_lights == 0;
}
/// Tells whether the environment is missing, or the surface is black to it.
bool is_dark_around(Forced s) {
    if (!s.scene.environment) return true;
    return !s.material.metallic_roughness && s.material.diffuse == glm::vec3(0.0F);
}
bool is_phong(Forced s) {
    return !s.planned.metallic_roughness;
}
bool is_isotropic(Forced s) {
    const auto& model = s.material.metallic_roughness;
    return !model || !(model->anisotropy > 0.0F);
}
bool has_stored_frame_or_no_coat(Forced s) {
    return s.planned.frame == TangentFrame::stored || !s.planned.clearcoat;
}
bool mirrors_nothing(Forced s) {
    return s.planned.reflection == ReflectionTerm::none;
}

/// Returns a decision with a reason about the material: "material 'body' is unlit".
Decision of_material(Subject s, bool on, const char* if_on, const char* if_off) {
    return {on, fmt::format("{} {}", s.name, on ? if_on : if_off)};
}

bool is_physical(Subject s) {
    return s.material.metallic_roughness.has_value();
}

Decision of_dielectric_reflectance(Subject s) {
    if (!is_physical(s)) return {false, s.name + " is Phong's model"};
    const MetallicRoughness& model = *s.material.metallic_roughness;
    const bool varies =
        shows(model.specular_texture, s.mesh) || shows(model.specular_color_texture, s.mesh);
    const bool differs =
        dielectric_reflectance(model) != dielectric_reflectance(MetallicRoughness{}) ||
        model.specular != 1.0F || varies;
    if (!differs) return {false, s.name + " reflects the 4% of the index 1.5"};
    const bool textured = shows(model.texture, s.mesh);
    const bool is_metal = model.metallic == 1.0F && !textured;
    return of_material(s, !is_metal, "has an index, weight or color of its own",
                       "is a metal everywhere");
}

Decision of_energy_compensation(Subject s) {
    if (!is_physical(s)) return {false, s.name + " is Phong's model"};
    return of_material(s, compensates_energy(*s.material.metallic_roughness),
                       "loses light that bounces between its facets",
                       "is a smooth dielectric, which loses less than 1% of what it mirrors");
}

/// Anisotropy needs a tangent frame: stored tangents, or texture coordinates to derive them from.
Decision of_anisotropy(Subject s) {
    if (!is_physical(s)) return {false, s.name + " is Phong's model"};
    if (!(s.material.metallic_roughness->anisotropy > 0.0F))
        return {false, s.name + " is as rough in all directions"};
    const bool has_tangents =
        s.material.tangent_frame == TangentFrame::stored && !s.mesh.tangents.empty();
    if (!has_tangents && s.mesh.texcoords.empty()) {
        return {false, fmt::format("{} has one, but mesh '{}' has no texture coordinates, so there "
                                   "is no tangent frame",
                                   s.name, s.mesh.name)};
    }
    return {true, s.name + " is rougher along a direction of the tangent frame"};
}

/// The same for the texture of a slot, which may be looked up at the second texture coordinates.
Decision of_texture(Subject s, TextureSlot slot) {
    const Texture* const texture = find_texture(s.material, slot);
    const bool at_first =
        texture == nullptr || !texture->second_texcoords || slot_info(slot).in_tangent_frame;
    if (at_first) return of_texture(s, texture != nullptr);
    if (s.mesh.texcoords_2.empty()) {
        return {false, fmt::format("{} has one, but mesh '{}' has no second texture coordinates",
                                   s.name, s.mesh.name)};
    }
    return {true, s.name + " has one and the mesh has second texture coordinates"};
}

/// Returns the row of the texture of a slot.
template <TextureSlot Slot>
EffectRow texture_row() {
    constexpr SlotEffect sampling = slot_effects[static_cast<std::size_t>(Slot)];
    return {.effect = one_switch<sampling.effect>(slot_info(Slot).effect, sampling.hidden),
            .decide = [](Subject s) { return of_texture(s, Slot); },
            .base = sampling.base,
            .part = sampling.part};
}

Decision of_vertex_colors(Subject s) {
    // Without the name, so that such meshes share their reasons.
    if (s.mesh.colors.empty()) return {false, "the mesh has none"};
    return {s.tinted,
            fmt::format("mesh '{}' has {}", s.mesh.name, s.tinted ? "them" : "only white ones")};
}

/// Alpha matters only if something makes it smaller than 1.
AlphaMode shown_alpha_mode(Subject s) {
    const Material& material = s.material;
    if (material.alpha_mode == AlphaMode::opaque) return AlphaMode::opaque;
    const bool textured =
        shows(material.diffuse_texture, s.mesh) || shows(material.opacity_texture, s.mesh);
    const bool varies = textured || s.tinted || material.opacity < 1.0F;
    if (material.alpha_mode == AlphaMode::blend) {
        return varies ? AlphaMode::blend : AlphaMode::opaque;
    }
    const bool covers = !varies && material.alpha_cutoff <= 1.0F;
    return covers ? AlphaMode::opaque : AlphaMode::mask;
}

Decision of_alpha(Subject s, AlphaMode mode) {
    const AlphaMode shown = shown_alpha_mode(s);
    const char* const reason = s.material.alpha_mode == AlphaMode::opaque ? "is opaque"
                               : shown == AlphaMode::opaque               ? "is covered everywhere"
                               : shown == AlphaMode::mask
                                   ? "has holes where alpha is below its cutoff"
                                   : "is blended with what is behind it";
    return of_material(s, shown == mode, reason, reason);
}

bool has_object_map(Subject s) {
    return s.material.normal_map && s.material.normal_map->space == NormalSpace::object;
}

template <typename Light>
Decision of_lights(const std::vector<Light>& lights, std::uint32_t shining) {
    if (lights.empty()) return {false, "the scene has none"};
    const std::string black =
        shining < lights.size() ? fmt::format(", {} of them black or off", lights.size() - shining)
                                : "";
    return {shining > 0, fmt::format("the scene has {}{}", lights.size(), black)};
}

Decision of_no_falloff(Subject s) {
    switch (s.lights.falloff) {
        case FalloffTerm::inverse_square:
            return {false, "every light falls off with the squared distance"};
        case FalloffTerm::none:
            return {true, "no light falls off with distance"};
        default:
            return {false, "some lights fall off with distance"};
    }
}

Decision of_mixed_falloff(Subject s) {
    if (s.lights.falloff != FalloffTerm::mixed) return {false, "all lights follow one law"};
    return {true, "some lights fall off with distance and some do not"};
}

Decision of_light_buffer(Subject s) {
    const std::uint32_t rows = light_row_layout(s.lights).count;
    return {
        rows > max_block_rows,
        fmt::format("the lights take {} of the {} rows of a uniform block", rows, max_block_rows)};
}

Decision of_shadow(Subject s) {
    if (!s.scene.shadow) return {false, "the scene requests none"};
    switch (s.lights.shadow) {
        case ShadowTerm::directional_light:
            return {true, "the first directional light that is on casts one"};
        case ShadowTerm::spot_light:
            return {true, "the first spot light that is on casts one"};
        case ShadowTerm::point_light:
            return {true, "the first point light that is on casts one"};
        default:
            return {false,
                    "no light shines from outside of the scene, or no surface casts a shadow"};
    }
}

/// Returns the effect of the shadow; switched on without the kind of its light, it is that of the
/// first kind of which there are lights.
Effect shadow_effect() {
    return {"shadow", [](const Features& f) { return f.shadow != ShadowTerm::none; },
            [](Features& f, bool on) {
                if (!on) {
                    f.shadow = ShadowTerm::none;
                } else if (f.shadow == ShadowTerm::none) {
                    f.shadow = f.directional_lights > 0 ? ShadowTerm::directional_light
                               : f.spot_lights > 0      ? ShadowTerm::spot_light
                                                        : ShadowTerm::point_light;
                }
            },
            not_lit};
}

Decision of_ambient(Subject s) {
    const glm::vec3 light = ambient_light(s.scene);
    if (!is_not_black(light)) return {false, "the scene has no ambient light"};
    const glm::vec3 scattered = light * s.material.ambient;
    const bool scatters = is_physical(s) || is_not_black(s.material.ambient);
    return {is_physical(s) || is_not_black(scattered),
            s.name + (scatters ? " scatters ambient light" : " scatters none")};
}

bool scatters_light(Subject s) {
    return is_physical(s) || is_not_black(s.material.diffuse);
}

Decision of_environment_light(Subject s) {
    if (!s.scene.environment) return {false, "the scene has no environment"};
    if (!s.scene.environment->lights) return {false, "the environment does not light surfaces"};
    return of_material(s, scatters_light(s), "scatters the environment's light", "is black");
}

Decision of_highlights(Subject s, bool phong) {
    const bool is_phong_model = s.material.specular_model == SpecularModel::phong;
    const bool shiny = !is_physical(s) && is_not_black(s.material.specular);
    const char* const reason = is_physical(s)   ? "has those of its own model"
                               : !shiny         ? "has none"
                               : is_phong_model ? "has Phong's"
                                                : "has the half vector's";
    return of_material(s, shiny && is_phong_model == phong, reason, reason);
}

bool reflects(Subject s) {
    return is_physical(s) || is_not_black(s.material.reflectivity);
}

Decision of_reflection(Subject s, bool glossy) {
    const bool rough = is_physical(s) || s.material.reflection_roughness > 0.0F;
    if (!reflects(s)) return {false, s.name + " reflects nothing"};
    if (!s.scene.environment) return {false, "the scene has no environment"};
    const char* const reason =
        rough ? "is rough and there is an environment" : "is a mirror and there is an environment";
    return of_material(s, rough == glossy, reason, reason);
}

Decision of_fresnel(Subject s, FresnelTerm term, const char* otherwise) {
    const Material& material = s.material;
    const bool varies = material.grazing_reflectivity != material.reflectivity;
    const FresnelTerm own = material.fresnel == FresnelModel::dielectric  ? FresnelTerm::dielectric
                            : material.fresnel == FresnelModel::conductor ? FresnelTerm::conductor
                            : varies                                      ? FresnelTerm::schlick
                                                                          : FresnelTerm::constant;
    if (!s.scene.environment || !reflects(s)) return {false, s.name + " reflects nothing"};
    if (is_physical(s)) return {false, s.name + " has its own model's"};
    return own == term ? Decision{true, s.name + " has it"} : Decision{false, otherwise};
}

Decision of_schlick(Subject s) {
    const bool varies = s.material.grazing_reflectivity != s.material.reflectivity;
    return of_fresnel(
        s, FresnelTerm::schlick,
        varies ? "an exact form is requested" : "reflectivity is the same at every angle");
}

Decision of_refraction(Subject s) {
    if (is_physical(s) && s.material.metallic_roughness->transmission > 0.0F)
        return {false, s.name + " shows what is behind it by transmission instead"};
    if (!(s.material.transmission > 0.0F) || is_physical(s))
        return {false, s.name + " transmits no light"};
    if (!s.scene.environment) return {false, "the scene has no environment"};
    return {true, s.name + " transmits the light that it does not reflect"};
}

Decision of_environment_tint(Subject s) {
    if (!s.material.environment_tint) return {false, s.name + " does not request it"};
    if (is_physical(s)) return {false, s.name + " is glTF's model"};
    if (!s.scene.environment) return {false, "the scene has no environment"};
    return {true, s.name + " has the color of the environment along its normal"};
}

Decision of_clamped_terms(Subject s) {
    if (!s.scene.clamp_terms) return {false, "the scene adds terms as they are"};
    return of_material(s, !is_physical(s), "clamps each term before the sum", "is glTF's model");
}

Decision of_rotation(Subject s) {
    if (!s.scene.environment) return {false, "the scene has no environment"};
    const bool is_rotated = s.scene.environment->rotation != 0.0F;
    return {is_rotated,
            is_rotated ? "the environment is rotated" : "the environment is not rotated"};
}

Decision of_tone(Subject s, ToneMapping tone) {
    if (s.scene.tone_mapping == tone) return {true, "the scene requests it"};
    return {false, s.scene.tone_mapping == ToneMapping::none ? "radiance above 1 is shown as 1"
                                                             : "the scene requests another curve"};
}

template <ToneMapping Tone>
EffectRow tone_row(const char* name) {
    return {.effect = one_value<&F::tone_mapping, Tone>(name, not_srgb),
            .decide = [](Subject s) { return of_tone(s, Tone); },
            .choice = "the tone curve is the scene's choice",
            .hidden_by = finishing_hidden_by};
}

Decision of_transmission(Subject s) {
    if (!is_physical(s)) return {false, s.name + " is Phong's model"};
    const MetallicRoughness& model = *s.material.metallic_roughness;
    if (!(model.transmission > 0.0F)) return {false, s.name + " transmits no light"};
    const bool textured = shows(model.texture, s.mesh);
    return of_material(s, model.metallic < 1.0F || textured, "shows what is behind it",
                       "is a metal everywhere");
}

const char* coat_map_hidden_by(const Features& requested, const Features& /*shown*/) {
    const bool flat = requested.interpolation == Interpolation::flat;
    return flat ? "flat shading uses only the triangle's normal" : "";
}

EffectRow coat_map_row() {
    EffectRow row = texture_row<TextureSlot::clearcoat_normal>();
    // Frames from derivatives have a normal of unit length, which the plain coat's is not exactly.
    row.choice = "the coat's normal would be rounded";
    row.neutral = has_stored_frame_or_no_coat;
    row.hidden_by = coat_map_hidden_by;
    return row;
}

/// Returns the rows of the textures of glTF's extensions, which show only with other effects.
std::vector<EffectRow> extension_texture_rows() {
    constexpr auto first = static_cast<std::size_t>(TextureSlot::specular_weight);
    constexpr auto coat_map = static_cast<std::size_t>(TextureSlot::clearcoat_normal);
    const auto rows_from = []<std::size_t... I>(std::index_sequence<I...>) {
        return std::vector<EffectRow>{texture_row<static_cast<TextureSlot>(first + I)>()...};
    };
    std::vector<EffectRow> rows = rows_from(std::make_index_sequence<texture_slot_count - first>());
    rows[coat_map - first] = coat_map_row();
    return rows;
}

std::vector<EffectRow> model_rows() {
    std::vector<EffectRow> rows = {
        {.effect = one_switch<&F::unlit>("unlit", ""),
         .decide = [](Subject s) { return of_material(s, s.material.unlit, "is unlit", "is lit"); },
         .choice = "whether light counts is the material's choice"},
        {.effect = one_switch<&F::metallic_roughness>("metallic-roughness", no_light),
         .decide =
             [](Subject s) {
                 return of_material(s, is_physical(s), "is glTF's model", "is Phong's model");
             },
         .choice = "its model is the material's choice"},
        texture_row<TextureSlot::metallic_roughness>(),
        {.effect = one_switch<&F::dielectric_reflectance>("dielectric reflectance",
                                                          "the material is not metallic-roughness"),
         .decide = of_dielectric_reflectance},
        {.effect = one_switch<&F::energy_compensation>("energy compensation", no_facets),
         .decide = of_energy_compensation},
        {.effect = one_switch<&F::sheen>("sheen", no_layer),
         .decide =
             [](Subject s) {
                 const bool has =
                     is_physical(s) && is_not_black(s.material.metallic_roughness->sheen_color);
                 return of_material(s, has, "has a sheen color", "has none");
             }},
        {.effect = one_switch<&F::clearcoat>("clearcoat", no_layer),
         .decide =
             [](Subject s) {
                 const bool has = is_physical(s) && s.material.metallic_roughness->clearcoat > 0.0F;
                 return of_material(s, has, "has a clear coat", "has none");
             }},
        {.effect = one_switch<&F::iridescence>("iridescence", no_layer),
         .decide =
             [](Subject s) {
                 const bool has =
                     is_physical(s) && s.material.metallic_roughness->iridescence > 0.0F;
                 return of_material(s, has, "has a thin film", "has none");
             }},
        {.effect =
             one_switch<&F::transmission>("transmission", "the material is not metallic-roughness"),
         .decide = of_transmission,
         .choice = "what is behind it would be drawn first"},
        {.effect = one_switch<&F::volume>("volume", "the surface transmits no light"),
         .decide =
             [](Subject s) {
                 const bool has = is_physical(s) && s.material.metallic_roughness->thickness > 0.0F;
                 return of_material(s, has, "encloses a volume", "is thin");
             },
         .choice = "a thin surface does not refract"},
        {.effect = one_switch<&F::dispersion>("dispersion", "there is no volume"),
         .decide =
             [](Subject s) {
                 const bool has = is_physical(s) &&
                                  s.material.metallic_roughness->dispersion > 0.0F &&
                                  s.material.metallic_roughness->refractive_index > 1.0F;
                 return of_material(s, has, "refracts red, green and blue differently",
                                    "refracts all colors alike");
             },
         .base = &F::volume,
         .part = "refraction.glsl#dispersion"},
        {.effect = one_switch<&F::anisotropy>("anisotropy", no_facets),
         .decide = of_anisotropy,
         .choice = "the mesh has no tangent frame",
         .neutral = is_isotropic},
    };
    for (EffectRow& row : extension_texture_rows())
        rows.push_back(std::move(row));
    return rows;
}

std::vector<EffectRow> interpolation_rows() {
    return {
        {.effect = one_value<&F::interpolation, Interpolation::gouraud>("Gouraud",
                                                                        "no light is interpolated"),
         .decide =
             [](Subject s) {
                 return of_material(s, s.material.interpolation == Interpolation::gouraud,
                                    "is lit at its vertices", "is lit at every pixel");
             },
         .choice = "the material determines where light is computed"},
        {.effect = one_value<&F::interpolation, Interpolation::flat>("flat", no_normal),
         .decide =
             [](Subject s) {
                 return of_material(s, s.material.interpolation == Interpolation::flat,
                                    "shows its facets", "interpolates its normals");
             },
         .choice = "the material determines where light is computed"},
    };
}

Decision of_morphing(Subject s) {
    if (s.pose == nullptr || s.pose->deformation->targets.empty())
        return {false, "the mesh has no morph targets"};
    const auto targets = static_cast<std::ptrdiff_t>(
        std::min(s.pose->deformation->targets.size(), s.pose->weights.size()));
    const auto at_rest =
        std::count(s.pose->weights.begin(), s.pose->weights.begin() + targets, 0.0F);
    if (at_rest == targets) return {false, "the weights of all morph targets are 0"};
    return {true, fmt::format("morph targets with a weight: {} of {}", targets - at_rest,
                              s.pose->deformation->targets.size())};
}

Decision of_skinning(Subject s) {
    if (s.pose == nullptr || s.pose->joint_matrices.empty())
        return {false, "the mesh has no joints"};
    const bool moves = is_skinned(*s.pose);
    return {moves, moves ? "joints move the vertices" : "all joints are at rest"};
}

Decision of_facets(Subject s) {
    if (s.pose == nullptr || !s.pose->has_flat_normals)
        return {false, "the mesh has no flat normals that are deformed"};
    if (!is_morphed(*s.pose) && !is_skinned(*s.pose)) return {false, "the mesh is not deformed"};
    return {true, "the normals are those of the deformed triangles"};
}

std::vector<EffectRow> deformation_rows() {
    return {
        {.effect = one_switch<&F::morphing>("morphing", ""),
         .decide = of_morphing,
         .follows_pose = true},
        {.effect = one_switch<&F::skinning>("skinning", ""),
         .decide = of_skinning,
         .follows_pose = true},
        {.effect = one_switch<&F::deformed_facets>("deformed facets", not_deformed),
         .decide = of_facets,
         .choice = "the mesh stores its normals",
         .follows_pose = true},
    };
}

std::vector<EffectRow> color_rows() {
    return {
        texture_row<TextureSlot::base_color>(),
        {.effect = one_switch<&F::vertex_colors>("vertex colors", no_color),
         .decide = of_vertex_colors},
        {.effect = one_value<&F::alpha, AlphaMode::mask>("alpha mask", ""),
         .decide = [](Subject s) { return of_alpha(s, AlphaMode::mask); }},
        {.effect = one_value<&F::alpha, AlphaMode::blend>("alpha blending", ""),
         .decide = [](Subject s) { return of_alpha(s, AlphaMode::blend); },
         .choice = "it hides nothing that is behind it, and is drawn after all else"},
        texture_row<TextureSlot::opacity>(),
    };
}

std::vector<EffectRow> normal_rows() {
    return {
        {.effect = one_value<&F::detail, NormalDetail::normal_map>("normal map", no_normal),
         .decide =
             [](Subject s) { return of_texture(s, s.material.normal_map && !has_object_map(s)); },
         .hidden_by = map_hidden_by},
        {.effect = one_value<&F::detail, NormalDetail::object_normal_map>("object-space normal map",
                                                                          no_normal),
         .decide = [](Subject s) { return of_texture(s, has_object_map(s)); },
         .choice = "without a map of its own it has no neutral value",
         .hidden_by = map_hidden_by},
        {.effect = one_value<&F::detail, NormalDetail::bump_map>("bump map", no_normal),
         .decide = [](Subject s) { return of_texture(s, s.material.bump_map.has_value()); },
         .hidden_by = map_hidden_by},
        {.effect = one_value<&F::frame, TangentFrame::derivatives>("derivative frames",
                                                                   "nothing needs a tangent frame"),
         .decide =
             [](Subject s) {
                 return of_material(s, s.material.tangent_frame == TangentFrame::derivatives,
                                    "computes its frame from derivatives",
                                    "uses the mesh's tangents");
             },
         .choice = "its map's frame is the material's choice"},
        {.effect = one_switch<&F::specular_antialiasing>("specular antialiasing",
                                                         "no normal map bends sharp highlights"),
         .decide =
             [](Subject s) {
                 return of_material(s, s.material.specular_antialiasing, "requests it",
                                    "does not request it");
             },
         .choice = "it would widen the highlights of its map",
         .neutral = has_no_map},
        {.effect = one_switch<&F::double_sided>("double-sided normals", no_normal),
         .decide =
             [](Subject s) {
                 return of_material(s, s.material.double_sided, "shows both sides",
                                    "shows its front only");
             },
         .hidden_by = sides_hidden_by},
    };
}

EffectRow occlusion_texture_row() {
    EffectRow row = texture_row<TextureSlot::occlusion>();
    row.decide = [](Subject s) {
        return s.material.occlusion_strength > 0.0F ? of_texture(s, TextureSlot::occlusion)
                                                    : of_texture(s, false);
    };
    return row;
}

EffectRow specular_texture_row() {
    EffectRow row = texture_row<TextureSlot::specular>();
    row.phong_only = true;
    return row;
}

std::vector<EffectRow> lighting_rows() {
    return {
        {.effect = lights<&F::directional_lights>("directional lights"),
         .decide =
             [](Subject s) {
                 return of_lights(s.scene.directional_lights, s.lights.directional_lights);
             }},
        {.effect = lights<&F::point_lights>("point lights"),
         .decide =
             [](Subject s) { return of_lights(s.scene.point_lights, s.lights.point_lights); }},
        {.effect = lights<&F::spot_lights>("spot lights"),
         .decide = [](Subject s) { return of_lights(s.scene.spot_lights, s.lights.spot_lights); }},
        {.effect = one_value<&F::falloff, FalloffTerm::none>("no falloff", no_light),
         .decide = of_no_falloff,
         .choice = "the lights fall off with distance",
         .neutral = has_no_positional_lights},
        {.effect = one_value<&F::falloff, FalloffTerm::mixed>("mixed falloff", no_light),
         .decide = of_mixed_falloff},
        {.effect = one_switch<&F::light_ranges>("light ranges", no_light),
         .decide = [](Subject s) -> Decision {
             if (!s.lights.light_ranges) return {false, "no light has one"};
             return {true, "a point or spot light has one"};
         }},
        {.effect = one_switch<&F::highlight_colors>("highlight colors", no_highlights),
         .decide = [](Subject s) -> Decision {
             if (!s.lights.highlight_colors)
                 return {false, "every light's highlights have the color of its light"};
             return {true, "a light has a separate color of highlights"};
         },
         .phong_only = true},
        {.effect = one_switch<&F::lights_in_buffer>("light buffer", no_light),
         .decide = of_light_buffer},
        {.effect = shadow_effect(),
         .decide = of_shadow,
         .choice = "whether lights cast shadows is the scene's choice"},
        {.effect = one_switch<&F::ambient>("ambient", ""), .decide = of_ambient},
        {.effect = one_switch<&F::diffuse>("diffuse", not_lit),
         .decide =
             [](Subject s) {
                 return of_material(s, scatters_light(s), "scatters light", "is black");
             }},
        {.effect = one_switch<&F::environment_diffuse>("environment light", ""),
         .decide = of_environment_light,
         .choice = "the environment does not light surfaces",
         .neutral = is_dark_around},
        occlusion_texture_row(),
        {.effect = one_switch<&F::vertex_occlusion>("vertex occlusion",
                                                    "there is no light from all around"),
         .decide = [](Subject s) -> Decision {
             if (s.is_occluded) return {true, "surfaces hide some of the light from all around"};
             return {false, s.scene.ambient_occlusion ? "no surface hides light of another one"
                                                      : "the scene does not request it"};
         }},
        {.effect = one_value<&F::specular, SpecularTerm::phong>("Phong highlights", not_lit),
         .decide = [](Subject s) { return of_highlights(s, true); },
         .phong_only = true},
        {.effect =
             one_value<&F::specular, SpecularTerm::blinn_phong>("Blinn-Phong highlights", not_lit),
         .decide = [](Subject s) { return of_highlights(s, false); },
         .phong_only = true},
        {.effect = one_switch<&F::highlight_fresnel>("highlight Fresnel", no_highlights),
         .decide =
             [](Subject s) {
                 if (!s.material.highlight_fresnel) return Decision{false, s.name + " has none"};
                 const bool grows = glm::any(glm::lessThan(s.material.specular, glm::vec3(1.0F)));
                 return Decision{grows, s.name + (grows ? " has it" : " has white highlights")};
             },
         .phong_only = true},
        specular_texture_row(),
        {.effect = one_switch<&F::environment_tint>(
             "environment tint", "the surface has no lit color to tint, or is glTF's model"),
         .decide = of_environment_tint,
         .choice = "the color of a surface's light is the material's choice"},
        {.effect = one_switch<&F::clamped_terms>("clamped terms",
                                                 "the surface is not lit, or is glTF's model"),
         .decide = of_clamped_terms,
         .choice = "whether terms are clamped is the scene's choice"},
        {.effect = one_switch<&F::emission>("emission", ""),
         .decide =
             [](Subject s) {
                 return of_material(s, is_not_black(s.material.emission), "shines", "has none");
             }},
        texture_row<TextureSlot::emission>(),
    };
}

std::vector<EffectRow> picture_rows() {
    return {
        {.effect = one_value<&F::reflection, ReflectionTerm::mirror>("mirror reflection", ""),
         .decide = [](Subject s) { return of_reflection(s, false); },
         .choice = "metallic-roughness has its own",
         .neutral = is_phong,
         .phong_only = true},
        {.effect = one_value<&F::reflection, ReflectionTerm::glossy>("glossy reflection", ""),
         .decide = [](Subject s) { return of_reflection(s, true); }},
        {.effect = one_switch<&F::reflection_by_normal>("reflection by normal", not_reflecting),
         .decide =
             [](Subject s) {
                 const bool has_it = s.material.reflection_by_normal;
                 return Decision{has_it, s.name + (has_it ? " has it" : " mirrors the view")};
             },
         .choice = "the direction of reflections is the material's choice",
         .phong_only = true},
        {.effect =
             one_value<&F::fresnel, FresnelTerm::schlick>("Schlick's Fresnel", not_reflecting),
         .decide = of_schlick,
         .phong_only = true},
        {.effect =
             one_value<&F::fresnel, FresnelTerm::dielectric>("dielectric Fresnel", not_reflecting),
         .decide =
             [](Subject s) {
                 return of_fresnel(s, FresnelTerm::dielectric, "it is not requested");
             },
         .choice = "how much it mirrors is the material's choice",
         .neutral = mirrors_nothing,
         .phong_only = true},
        {.effect =
             one_value<&F::fresnel, FresnelTerm::conductor>("conductor Fresnel", not_reflecting),
         .decide =
             [](Subject s) { return of_fresnel(s, FresnelTerm::conductor, "it is not requested"); },
         .choice = "how much it mirrors is the material's choice",
         .neutral = mirrors_nothing,
         .phong_only = true},
        {.effect = one_switch<&F::environment_rotation>(
             "environment rotation", "the surface neither mirrors the environment nor refracts it"),
         .decide = of_rotation},
        {.effect = one_switch<&F::refraction>("refraction", "glTF's model transmits no light"),
         .decide = of_refraction,
         .phong_only = true},
        {.effect = one_switch<&F::exposure>("exposure", not_srgb),
         .decide = [](Subject s) -> Decision {
             return {s.scene.exposure != 1.0F,
                     fmt::format("the scene's exposure is {}", s.scene.exposure)};
         },
         .hidden_by = finishing_hidden_by},
        tone_row<ToneMapping::reinhard>("Reinhard tone mapping"),
        tone_row<ToneMapping::aces>("ACES tone mapping"),
        tone_row<ToneMapping::khronos_neutral>("Khronos neutral tone mapping"),
        tone_row<ToneMapping::aces_hill>("ACES Hill tone mapping"),
        tone_row<ToneMapping::aces_hill_boost>("boosted ACES Hill tone mapping"),
    };
}

/// True if vertex colors change the picture, their alpha included if the material uses it.
bool has_tint(const Material& material, const Mesh& mesh) {
    const bool alpha_counts = material.alpha_mode != AlphaMode::opaque;
    return std::any_of(mesh.colors.begin(), mesh.colors.end(), [&](const glm::vec4& color) {
        return glm::vec3(color) != glm::vec3(1.0F) || (alpha_counts && color.a != 1.0F);
    });
}

template <typename Light>
std::uint32_t shining_count(const std::vector<Light>& lights) {
    return static_cast<std::uint32_t>(std::count_if(
        lights.begin(), lights.end(), [](const Light& light) { return shines(light); }));
}

/// Returns the point and spot lights that shine.
std::vector<const PointLight*> positional_lights(const Scene& scene) {
    std::vector<const PointLight*> result;
    for (const PointLight& light : scene.point_lights)
        if (shines(light)) result.push_back(&light);
    for (const SpotLight& light : scene.spot_lights)
        if (shines(light)) result.push_back(&light.point);
    return result;
}

/// Returns the scene's lights as features.
Features lights_of(const Scene& scene) {
    const std::vector<const PointLight*> positional = positional_lights(scene);
    const auto any = [&](const auto& condition) {
        return std::any_of(positional.begin(), positional.end(), condition);
    };
    const auto falls = [](const PointLight* light) {
        return light->falloff == Falloff::inverse_square;
    };
    const auto differs = [](const std::optional<glm::vec3>& highlights, const glm::vec3& light) {
        return highlights && *highlights != light;
    };
    Features f;
    f.directional_lights = shining_count(scene.directional_lights);
    f.point_lights = shining_count(scene.point_lights);
    f.spot_lights = shining_count(scene.spot_lights);
    f.falloff = std::all_of(positional.begin(), positional.end(), falls)
                    ? FalloffTerm::inverse_square
                : any(falls) ? FalloffTerm::mixed
                             : FalloffTerm::none;
    f.light_ranges = any([](const PointLight* light) { return light->range.has_value(); });
    f.highlight_colors =
        any([&](const PointLight* light) {
            return differs(light->highlight_intensity, light->intensity);
        }) ||
        std::any_of(scene.directional_lights.begin(), scene.directional_lights.end(),
                    [&](const DirectionalLight& light) {
                        return shines(light) &&
                               differs(light.highlight_irradiance, light.irradiance);
                    });
    return f;
}

}  // namespace

Decision detail::of_texture(const DrawSubject& s, bool has_texture) {
    if (!has_texture) return {false, s.name + " has none"};
    if (s.mesh.texcoords.empty()) {
        return {false, fmt::format("{} has one, but mesh '{}' has no texture coordinates", s.name,
                                   s.mesh.name)};
    }
    return {true, s.name + " has one and the mesh has texture coordinates"};
}

DrawSubject detail::draw_subject(const Scene& scene, const Material& material,
                                 const std::string& name, const Mesh& mesh,
                                 const Instance* instance, ShadowTerm shadow) {
    Features lights = lights_of(scene);
    lights.shadow = shadow;
    DrawSubject subject{scene, material, mesh, name, has_tint(material, mesh), lights};
    if (instance == nullptr) return subject;
    if (instance->pose) subject.pose = &*instance->pose;
    const std::vector<float>& shares = instance->open_shares;
    subject.is_occluded =
        std::any_of(shares.begin(), shares.end(), [](float share) { return share != 1.0F; });
    return subject;
}

std::uint32_t detail::second_texcoords_of(const Material& material) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < texture_slot_count; ++i) {
        const Texture* const texture = find_texture(material, texture_slots[i].slot);
        const bool is_second = texture != nullptr && texture->second_texcoords;
        if (is_second && !texture_slots[i].in_tangent_frame) bits |= 1U << i;
    }
    return bits;
}

const std::vector<EffectRow>& detail::effect_rows() {
    static const std::vector<EffectRow> all = [] {
        std::vector<EffectRow> rows = model_rows();
        for (const auto& more : {interpolation_rows(), deformation_rows(), color_rows(),
                                 normal_rows(), relief_rows(), lighting_rows(), picture_rows()})
            rows.insert(rows.end(), more.begin(), more.end());
        return rows;
    }();
    return all;
}

const std::vector<Effect>& effects() {
    static const std::vector<Effect> all = [] {
        std::vector<Effect> result;
        for (const EffectRow& row : effect_rows())
            result.push_back(row.effect);
        return result;
    }();
    return all;
}

const EffectRow* detail::find_effect(std::string_view name) {
    const auto& all = effect_rows();
    const auto row = std::find_if(all.begin(), all.end(),
                                  [&](const EffectRow& r) { return r.effect.name == name; });
    return row == all.end() ? nullptr : &*row;
}

std::string detail::hidden_reason(const EffectRow& row, const Features& requested,
                                  const Features& shown) {
    if (shown.unlit) return "the material is unlit";
    const std::string specific = row.hidden_by == nullptr ? "" : row.hidden_by(requested, shown);
    if (!specific.empty()) return specific;
    if (shown.metallic_roughness && row.phong_only) return "metallic-roughness has its own";
    return row.effect.hidden;
}

}  // namespace relief::shade
