// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a scene calls for, and why. Pure: no OpenGL, no files.
///
/// Every draw (one material range of one instance) gets a Features value. It names everything its
/// program, vertex streams and textures will hold; what is not in it has no code, no uniform, no
/// memory and no time. Leaving an effect out never changes a pixel, because it is left out only
/// where its contribution is exactly nothing (effect_forcing.h puts it in all the same). Tests:
/// tests/shade/effects/, tests/shade/render/forced_effects_test.cpp.
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "relief/mesh/report.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/scene.h"

namespace relief {

/// What bends the normal.
enum class NormalDetail : std::uint8_t { none, normal_map, object_normal_map, bump_map };

enum class SpecularTerm : std::uint8_t { none, phong, blinn_phong };

/// How the environment is mirrored.
enum class ReflectionTerm : std::uint8_t {
    none,
    mirror,
    glossy,  ///< Blurred, from a prefiltered chain of mip levels.
};

/// How much of it, by angle.
enum class FresnelTerm : std::uint8_t { constant, schlick, dielectric, conductor };

/// How a lamp's light gets less with distance.
enum class FalloffTerm : std::uint8_t {
    inverse_square,
    none,
    mixed,  ///< Some lamps fall off and some do not.
};

/// What one draw needs. Two draws with equal Features share one program.
struct Features {
    // Where and by which model light is computed.
    bool unlit = false;  ///< No light at all: the diffuse colour is the picture.
    bool metallic_roughness = false;
    Interpolation interpolation = Interpolation::per_pixel;
    // What multiplies the colours.
    bool diffuse_texture = false;
    bool specular_texture = false;
    bool metallic_roughness_texture = false;
    bool occlusion_texture = false;
    bool vertex_colors = false;
    // What is there at all.
    AlphaMode alpha = AlphaMode::opaque;
    bool opacity_texture = false;
    // The normal.
    NormalDetail detail = NormalDetail::none;
    TangentFrame frame = TangentFrame::stored;  ///< Of a normal map in tangent space or a bump map.
    bool specular_antialiasing = false;
    bool double_sided = false;  ///< Back faces show the opposite of their normal.
    // Light.
    bool ambient = false;
    std::uint32_t directional_lights = 0;
    std::uint32_t point_lights = 0;
    std::uint32_t spot_lights = 0;
    FalloffTerm falloff = FalloffTerm::inverse_square;
    bool light_ranges = false;      ///< Some point or spot light has a range.
    bool highlight_colors = false;  ///< Some lamp's highlights have a colour of their own.
    bool lights_in_buffer = false;  ///< Too many for a uniform block.
    bool environment_diffuse = false;
    bool diffuse = false;  ///< Lamps scattered diffusely (not for black surfaces).
    SpecularTerm specular = SpecularTerm::none;  ///< Phong's model only.
    bool emission = false;
    bool emission_texture = false;
    // The environment in the surface.
    ReflectionTerm reflection = ReflectionTerm::none;
    FresnelTerm fresnel = FresnelTerm::constant;  ///< Phong's model only.
    bool refraction = false;
    // The picture.
    OutputCoding output = OutputCoding::srgb;
    ToneMapping tone_mapping = ToneMapping::none;
    bool exposure = false;
    DebugView view = DebugView::picture;  ///< What is shown of all this.

    friend auto operator<=>(const Features&, const Features&) = default;
};

/// "normal map, 2 directional lights, diffuse, Blinn-Phong, sRGB", for messages.
std::string describe(const Features& features);

/// One effect, on or off, and the reason in words that name the thing that decided it.
struct EffectReason {
    std::string effect;  ///< "normal map"
    bool on = false;
    std::string reason;  ///< "material 'body' has one and the mesh has texture coordinates"
};

/// What one draw needs and why.
struct DrawPlan {
    std::size_t instance = 0;
    MaterialRange range;
    Features features;
    std::vector<EffectReason> reasons;
    bool needs_tangents = false;  ///< The mesh has none, and the normal map needs them: compute.
};

/// The whole frame.
struct FramePlan {
    std::vector<DrawPlan> draws;
    bool environment_map = false;         ///< Decoded and uploaded at all.
    bool prefiltered_map = false;         ///< Blurred into mip levels for glossy reflections.
    bool environment_brdf = false;        ///< The table of GGX's directional albedo.
    bool environment_irradiance = false;  ///< Its spherical harmonics.
    bool skybox = false;
    bool sorted_blending = false;       ///< Blended draws last, farthest triangle first.
    bool finishing_pass = false;        ///< Samples are averaged and coded after all is drawn.
    std::vector<EffectReason> reasons;  ///< Of the frame-wide effects.
};

/// What a draw of this material and mesh in this scene needs; a canonical value.
Features features_of(const Scene& scene, const Material& material, const Mesh& mesh,
                     OutputCoding output = OutputCoding::srgb);

/// The whole scene's plan; the scene must be valid.
FramePlan plan_effects(const Scene& scene, const FrameSettings& settings);

/// Sets what is frame-wide from the draws: after features were changed by hand.
void plan_frame(const Scene& scene, const FrameSettings& settings, FramePlan& plan);

/// The plan with every draw showing what the settings' view says, and nothing planned that the view
/// does not need; as it was if that is the picture. Renderer does this itself.
///
/// \param report  counts draws for which the view has no meaning
/// \throws InvalidInput if it has none for any of them, with the reason
FramePlan plan_view(const Scene& scene, const FrameSettings& settings, FramePlan plan,
                    Report& report);

/// Drops what cannot show: without light no normal, without normal no normal map, and so on.
/// features_of() already returns canonical values; canonical(canonical(f)) == canonical(f).
Features canonical(Features features);

/// An effect as users name it.
struct Effect {
    const char* name;
    /// Whether these features have it.
    bool (*on)(const Features& features);
    /// Puts it in, with as little as it takes, or takes it out. What canonical() says comes after.
    void (*set)(Features& features, bool on);
    /// Why canonical() drops it where it cannot show.
    const char* hidden;
};

/// Every effect that a draw may have, in the order of the plan's reasons.
const std::vector<Effect>& effects();

/// Everything that a draw's program takes from outside, by GLSL name, each list sorted.
struct PlannedInterface {
    std::vector<std::string> attributes;
    std::vector<std::string> uniforms;
    std::vector<std::string> uniform_blocks;
    std::vector<std::string> samplers;

    friend bool operator==(const PlannedInterface&, const PlannedInterface&) = default;
};

/// What the program for these features takes: exactly what is active in it once linked.
PlannedInterface planned_interface(const Features& features);

/// The default material, of meshes that name none.
const Material& default_material();

}  // namespace relief
