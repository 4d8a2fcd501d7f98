// SPDX-License-Identifier: Apache-2.0
/// \file
/// Effects as planning, shader assembly and drawing share them: questions about a set of effects,
/// and the table of effects, in which one row describes everything that planning and forcing know
/// of an effect. Shader parts that depend on several effects are in surface_steps.cpp. Pure.
/// Tests: tests/shade/effects/effects_test.cpp, plan_test.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "relief/shade/effects.h"

namespace relief::shade::detail {

// Questions about a set of effects

/// Returns the number of directional, point and spot lights.
inline std::uint32_t light_count(const Features& f) {
    return f.directional_lights + f.point_lights + f.spot_lights;
}

/// True if a map or anisotropy lies in the tangent frame.
inline bool lies_in_frame(const Features& f) {
    return f.detail == NormalDetail::normal_map || f.detail == NormalDetail::bump_map ||
           f.anisotropy || f.clearcoat_normal_map;
}

/// True if morph targets or joints deform the mesh.
inline bool is_deformed(const Features& f) {
    return f.morphing || f.skinning;
}

/// True if the view shows texture coordinates displaced, if anything is looked up at them.
inline bool is_displaced(const Features& f) {
    return f.depth_mapping != DepthMapping::none;
}

/// True if the view is a term that reflections only dim: no mirror image is looked up.
inline bool has_black_mirror(const Features& f) {
    return is_term(f.view) && f.view != DebugView::reflection;
}

/// True if the view is a term that refraction only dims.
inline bool has_black_transmission(const Features& f) {
    return is_term(f.view) && f.view != DebugView::refraction;
}

/// True if the surface shows what is behind it by transmission. In a view of one term, transmission
/// only dims the scattered light: what is behind belongs to other terms.
inline bool transmits(const Features& f) {
    return f.transmission && !is_term(f.view);
}

/// True if a mirror image is looked up along the normal or a reflected direction.
inline bool looks_up_mirror(const Features& f) {
    return f.reflection != ReflectionTerm::none && (f.metallic_roughness || !has_black_mirror(f));
}

/// True if the environment behind the surface is looked up along a refracted direction.
inline bool looks_up_refraction(const Features& f) {
    return f.refraction && !has_black_transmission(f);
}

/// True if reflection or refraction depends on the direction to the eye.
inline bool reflection_shows_view(const Features& f) {
    const bool by_angle = f.reflection != ReflectionTerm::none &&
                          (f.metallic_roughness || f.fresnel != FresnelTerm::constant);
    return by_angle || (looks_up_mirror(f) && !f.reflection_by_normal) || looks_up_refraction(f);
}

/// True if a lookup of the environment depends on the normal.
inline bool reflection_shows_normal(const Features& f) {
    return reflection_shows_view(f) || looks_up_mirror(f) || f.environment_tint;
}

/// True if the view shows a vector of the tangent frame.
inline bool shows_frame(const Features& f) {
    return f.view == DebugView::tangent || f.view == DebugView::bitangent ||
           f.view == DebugView::handedness;
}

/// True if the view shows a normal.
inline bool shows_normal(const Features& f) {
    return f.view == DebugView::geometric_normal || f.view == DebugView::shading_normal;
}

/// The forms of the environment that a frame's draws look up. The plan reports them; the renderer
/// prepares them, also for draws that were changed by hand.
struct EnvironmentNeeds {
    bool sharp = false;       ///< Mirrored without blur, seen through a surface, or its tint.
    bool blurred = false;     ///< Mirrored by rough surfaces, or shown by a blurred skybox.
    bool irradiance = false;  ///< Scattered.
    bool brdf = false;        ///< GGX's directional albedo, for metallic-roughness.

    [[nodiscard]] bool any() const { return sharp || blurred || irradiance; }
};

EnvironmentNeeds environment_needs(const FramePlan& plan);

// Textures

/// The effect that samples the texture of a slot.
struct SlotEffect {
    bool Features::*effect;          ///< Null for the maps of detail and depth_mapping.
    const char* hidden;              ///< The reason why canonical() drops it.
    bool Features::*base = nullptr;  ///< EffectRow::base
    const char* part = "";           ///< EffectRow::part
};

/// The effects of textures, by slot. Those of glTF's extensions get their rows of the table of
/// effects from here.
inline constexpr std::array<SlotEffect, texture_slot_count> slot_effects{{
    {&Features::diffuse_texture, "there is no scattered light to tint"},
    {&Features::specular_texture, "there are no highlights"},
    {&Features::metallic_roughness_texture, "the material is not metallic-roughness"},
    {nullptr, ""},
    {nullptr, ""},
    {nullptr, ""},
    {nullptr, ""},
    {&Features::occlusion_texture, "there is no light from all around"},
    {&Features::emission_texture, "the material has no emission that it could tint",
     &Features::emission},
    {&Features::opacity_texture, "the material is opaque"},
    {&Features::specular_weight_texture, "dielectrics reflect the 4% of the index 1.5",
     &Features::dielectric_reflectance, "metallic_roughness.glsl#weight_texture"},
    {&Features::specular_color_texture, "dielectrics reflect the 4% of the index 1.5",
     &Features::dielectric_reflectance, "metallic_roughness.glsl#color_texture"},
    {&Features::sheen_color_texture, "there is no sheen", &Features::sheen,
     "sheen.glsl#color_texture"},
    {&Features::sheen_roughness_texture, "there is no sheen", &Features::sheen,
     "sheen.glsl#albedo_by_texture"},
    {&Features::clearcoat_texture, "there is no coat", &Features::clearcoat,
     "clearcoat.glsl#texture"},
    {&Features::clearcoat_roughness_texture, "there is no coat, or it reflects nothing",
     &Features::clearcoat, "clearcoat.glsl#roughness_texture"},
    {&Features::clearcoat_normal_map, "there is no coat", &Features::clearcoat,
     "clearcoat.glsl#normal_map"},
    {&Features::anisotropy_texture, "there is no anisotropy", &Features::anisotropy,
     "anisotropy.glsl#texture"},
    {&Features::iridescence_texture, "there is no film", &Features::iridescence,
     "iridescence.glsl#texture"},
    {&Features::film_thickness_texture, "there is no film", &Features::iridescence,
     "iridescence.glsl#thickness_texture"},
    {&Features::transmission_texture, "the surface transmits no light", &Features::transmission,
     "refraction.glsl#transmission_texture"},
    {&Features::thickness_texture, "there is no volume", &Features::volume,
     "refraction.glsl#thickness_texture"},
}};

/// Calls visit(texture, bit) for each texture that these features sample and that may be looked up
/// at the second texture coordinates. Its bit of Features::second_texcoords is 1 << slot.
template <typename Visit>
void for_each_second_bit(const Features& f, const Visit& visit) {
    for (std::size_t i = 0; i < texture_slot_count; ++i) {
        const bool Features::*const effect = slot_effects[i].effect;
        if (effect != nullptr && !texture_slots[i].in_tangent_frame && f.*effect)
            visit(texture_slots[i], 1U << i);
    }
}

/// Calls visit(texture, is_second) for each of them that these features sample.
template <typename Visit>
void for_each_sampled(const Features& f, const Visit& visit) {
    for_each_second_bit(f, [&](const TextureSlotInfo& texture, std::uint32_t bit) {
        visit(texture, (f.second_texcoords & bit) != 0);
    });
}

/// Returns the bits of the textures that a material looks up at the second texture coordinates.
std::uint32_t second_texcoords_of(const Material& material);

/// True if these features show a displacement of texture coordinates.
bool shows_displacement(const Features& f);

/// True if the program has the wrap modes of the height map.
inline bool has_height_wraps(const Features& f) {
    return f.depth_mapping == DepthMapping::maximum_mipmaps || f.self_shadow || f.clipped_relief ||
           f.displaced_shadow;
}

/// Returns the features of the program that draws the depth of a draw into the shadow maps.
Features casting_features(Features features);

/// Sets the wrap modes of the material's height map, if the program has them.
void set_height_wraps(const Material& material, Features& f);

/// Returns the texture coordinates at which a texture is looked up.
inline const std::vector<glm::vec2>& texcoords_of(const Mesh& mesh, const Texture& texture) {
    return texture.second_texcoords ? mesh.texcoords_2 : mesh.texcoords;
}

/// True if there is a texture, and the mesh has texture coordinates for it.
inline bool shows(const std::optional<Texture>& texture, const Mesh& mesh) {
    return texture && !texcoords_of(mesh, *texture).empty();
}

// The table of effects

/// The decision whether the scene calls for an effect, with its reason.
struct Decision {
    bool on = false;
    std::string reason;
};

/// Upper bounds, in pixels, of what the relief of a draw changes; infinite if it reaches the eye.
struct ReliefBounds {
    double shift = 0.0;   ///< How far it displaces what the picture shows.
    double depth = 0.0;   ///< How deep it is.
    double curve = 0.0;   ///< How far it displaces it where normals differ; 0 on flat meshes.
    double shadow = 0.0;  ///< The length of its self-shadows, if the material requests them;
                          ///< infinite if light arrives along the surface or from below it.
};

/// The input of the decisions for one draw.
struct DrawSubject {
    const Scene& scene;
    const Material& material;
    const Mesh& mesh;
    std::string name;     ///< "material 'body'", for the reasons.
    bool tinted = false;  ///< The mesh's vertex colors change the picture, or its alpha does.
    Features lights;  ///< The scene's lights: counts, falloff, ranges, highlight colors, shadow.
    const MeshPose* pose = nullptr;  ///< Null if nothing can deform the mesh.
    bool is_occluded = false;        ///< Some open share of the instance is not 1.
    /// relief_bounds(); none if the draw is seen from any camera.
    std::optional<ReliefBounds> relief = std::nullopt;
};

/// Returns the bounds of the material's relief over some triangles; none if they are not known:
/// without a camera, for a deformed mesh, or if the size of the height map cannot be read.
///
/// A point of the relief and the point of the surface above it are at most a depth apart. On the
/// screen they are as far apart as that distance at the nearest corner, times the sine of the
/// steepest angle between view and normal. A shadow is as long as the depth times the tangent of
/// the flattest angle of light.
std::optional<ReliefBounds> relief_bounds(const Scene& scene, const Instance& instance,
                                          const MaterialRange& range,
                                          const FrameSettings& settings);

/// \param instance  null: a mesh at rest without open shares
/// \param shadow    shadow_term() of the scene
DrawSubject draw_subject(const Scene& scene, const Material& material, const std::string& name,
                         const Mesh& mesh, const Instance* instance, ShadowTerm shadow);

/// A draw on which effects are forced.
struct ForcingSubject {
    const Scene& scene;
    const Material& material;
    const Features& planned;
};

struct EffectRow {
    Effect effect;  ///< Name, test, setter, and why canonical() drops it.
    Decision (*decide)(const DrawSubject& subject) = nullptr;
    /// If the effect changes the picture when it is forced on: whose choice it is.
    const char* choice = nullptr;
    /// With a choice: true if the effect is nevertheless neutral on this draw. Null: it never is.
    bool (*neutral)(const ForcingSubject& subject) = nullptr;
    /// A more specific reason than effect.hidden; "" if it does not apply.
    const char* (*hidden_by)(const Features& requested, const Features& shown) = nullptr;
    bool phong_only = false;         ///< glTF's model has its own form of it, or none.
    bool follows_pose = false;       ///< The decision depends on DrawSubject::pose alone.
    bool Features::*base = nullptr;  ///< The effect without which canonical() drops it, or null.
    const char* part = "";  ///< The part of the fragment shader that it alone chooses, or "".
    /// Forced on, the effect may change the picture, within a bound: only requests by name add it.
    bool only_by_name = false;
};

/// Returns an effect that is one switch.
template <bool Features::*Member>
Effect one_switch(const char* name, const char* hidden) {
    return {name, [](const Features& f) { return f.*Member; },
            [](Features& f, bool on) { f.*Member = on; }, hidden};
}

/// Returns an effect that is one value of an enumeration; switched off, its first value takes its
/// place.
template <auto Member, auto Value>
Effect one_value(const char* name, const char* hidden) {
    return {name, [](const Features& f) { return f.*Member == Value; },
            [](Features& f, bool on) {
                if (on) {
                    f.*Member = Value;
                } else if (f.*Member == Value) {
                    f.*Member = {};
                }
            },
            hidden};
}

/// Decides whether a texture shows, which it does only on a mesh with texture coordinates.
Decision of_texture(const DrawSubject& subject, bool has_texture);

/// The rows of a relief.
std::vector<EffectRow> relief_rows();

/// A frame-wide effect. All but the skybox follow from the draws and the settings.
struct FrameEffect {
    std::string_view name;
    bool FramePlan::*member;
};
inline constexpr std::array frame_effects = {
    FrameEffect{"skybox", &FramePlan::skybox},
    FrameEffect{"blurred skybox", &FramePlan::blurred_skybox},
    FrameEffect{"environment map", &FramePlan::environment_map},
    FrameEffect{"prefiltered environment", &FramePlan::prefiltered_map},
    FrameEffect{"environment BRDF table", &FramePlan::environment_brdf},
    FrameEffect{"environment irradiance", &FramePlan::environment_irradiance},
    FrameEffect{"shadow maps", &FramePlan::shadow_maps},
    FrameEffect{"transmission background", &FramePlan::transmission_background},
    FrameEffect{"sorted blending", &FramePlan::sorted_blending},
    FrameEffect{"finishing pass", &FramePlan::finishing_pass},
};

/// All rows, in the order of the plan's reasons.
const std::vector<EffectRow>& effect_rows();

/// Returns the row of this name; null if there is none.
const EffectRow* find_effect(std::string_view name);

/// Returns the reason why canonical() dropped an effect.
///
/// \param requested  the requested effects  \param shown  the effects that canonical() left
std::string hidden_reason(const EffectRow& row, const Features& requested, const Features& shown);

}  // namespace relief::shade::detail
