// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a scene calls for, and why. Pure: no OpenGL, no files.
///
/// Every draw (one material range of one instance) gets a Features value. It names everything its
/// program, vertex streams and textures will hold; what is not in it has no code, no uniform, no
/// memory and no time. Leaving an effect out never changes a pixel, because it is left out only
/// where its contribution is exactly nothing (in linear float, to the rounding of an interpolated
/// 1, for white vertex colours). Tests: tests/shade/effects/,
/// tests/shade/render/forced_effects_test.cpp.
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "relief/shade/scene.h"

namespace relief {

enum class SpecularTerm : std::uint8_t { none, phong, blinn_phong };

/// How the finished radiance is stored: part of the program, since it is its last line.
enum class OutputCoding : std::uint8_t {
    linear,   ///< Radiance as it is.
    clamped,  ///< Linear, no more than 1: what multisampled srgb frames average.
    srgb,     ///< No more than 1, as sRGB codes.
};

/// What one draw needs. Two draws with equal Features share one program.
struct Features {
    // What multiplies the colours that are scattered.
    bool diffuse_texture = false;
    bool vertex_colors = false;
    // The normal: the interpolated one, or bent by a tangent-space map.
    bool normal_map = false;
    bool double_sided = false;  ///< Back faces show the opposite of their normal.
    // The light.
    bool unlit = false;  ///< No light at all: the diffuse colour is the picture.
    bool ambient = false;
    std::uint32_t directional_lights = 0;
    std::uint32_t point_lights = 0;
    std::uint32_t spot_lights = 0;
    bool diffuse = false;  ///< Any light scattered diffusely (not for black surfaces).
    SpecularTerm specular = SpecularTerm::none;
    bool light_ranges = false;      ///< Some point or spot light has a range.
    bool lights_in_buffer = false;  ///< Too many for a uniform block.
    bool emission = false;
    bool emission_texture = false;
    bool reflection = false;  ///< Of the environment, with Schlick's Fresnel term.
    OutputCoding output = OutputCoding::srgb;

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
    bool environment_map = false;  ///< Decoded and uploaded at all.
    bool skybox = false;
    std::vector<EffectReason> reasons;  ///< Of the frame-wide effects.
};

/// What a draw of this material and mesh in this scene needs; a canonical value.
Features features_of(const Scene& scene, const Material& material, const Mesh& mesh,
                     OutputCoding output = OutputCoding::srgb);

/// The whole scene's plan; the scene must be valid.
FramePlan plan_effects(const Scene& scene, OutputCoding output);

/// Drops what cannot show: without light no normal, without normal no normal map, and so on.
/// features_of() already returns canonical values; canonical(canonical(f)) == canonical(f).
Features canonical(Features features);

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
