// SPDX-License-Identifier: Apache-2.0
/// \file
/// Forces effects on or off by name, independent of the scene. Pure: no OpenGL, no files.
///
/// An effect that is forced on without anything to show is neutral: its values are zero, its
/// texture is white, its lights are black, and the picture does not change by a bit. Effects
/// without a neutral form are properties of the scene and are refused: the reflection model and
/// interpolation (unlit, metallic-roughness, Gouraud, flat), the meaning of maps (object-space
/// normal maps, derivative frames, antialiasing of an existing map), blending, the falloff of
/// existing lights, the exact Fresnel term of an existing reflection, tone curves, and whether the
/// environment is visible or lights surfaces. Any effect can be forced off, which changes the
/// picture.
/// Tests: tests/shade/effects/effects_test.cpp, tests/shade/render/forced_effects_test.cpp.
#pragma once

#include <string>
#include <vector>

#include "relief/shade/effects.h"

namespace relief {

/// The effects before single ones are forced.
enum class EffectBase {
    planned,      ///< The effects that the scene requires.
    all_neutral,  ///< These, and on every draw all effects that change no pixel there.
    nothing,      ///< No effects; effects that are forced on have the values of the scene.
};

/// One effect by name (effects(), or a frame-wide one of FramePlan::reasons). Case and separators
/// do not matter: "normal map", "Normal-Map".
struct ForcedEffect {
    std::string name;
    bool on = true;
};

struct EffectRequest {
    EffectBase base = EffectBase::planned;
    std::vector<ForcedEffect> forced;
};

/// Forces effects on and off on every draw of a plan, and updates their reasons.
///
/// \param plan  of this scene and these settings
/// \return a plan for Renderer. An effect that is forced on shows on every draw that can have it;
///         the reasons of the other draws explain why they cannot
/// \throws InvalidInput if there is no effect of a name (similar names are suggested), one name is
///         forced both ways, two effects exclude each other, or no draw can have an effect: the
///         message names effect, material and reason
FramePlan force_effects(const Scene& scene, const FrameSettings& settings, FramePlan plan,
                        const EffectRequest& requests);

/// Returns the effects that are on in any draw of a plan, and "skybox": those that can be forced
/// off.
std::vector<std::string> effects_in(const FramePlan& plan);

}  // namespace relief
