// SPDX-License-Identifier: Apache-2.0
/// \file
/// Forces effects on or off by name, whatever the scene calls for. Pure: no OpenGL, no files.
///
/// An effect that is forced on without anything to show is neutral: its numbers are zero, its
/// texture white, its lights black, and the picture stays the same, bit for bit. Effects without a
/// neutral form are choices of the scene, and are refused: the reflection model and interpolation
/// (unlit, metallic-roughness, Gouraud, flat), the meaning of maps (object-space normal maps,
/// derivative frames, antialiasing of a real map), blending, the falloff of existing lights, the
/// exact Fresnel term of an existing reflection, tone curves, and whether the environment is
/// visible or lights surfaces. Any effect can be forced off; that changes the picture. Tests:
/// tests/shade/effects/effect_forcing_test.cpp, tests/shade/render/forced_effects_test.cpp.
#pragma once

#include <string>
#include <vector>

#include "relief/shade/effects.h"

namespace relief {

/// The effects before single ones are forced.
enum class EffectBase {
    planned,      ///< Those that the scene calls for.
    all_neutral,  ///< Those, and on every draw each effect that changes no pixel there.
    nothing,      ///< None; effects forced on are as the scene has them.
};

/// One effect by name (effects(), or a frame-wide one of FramePlan::reasons). Case and separators
/// do not matter: "normal map", "Normal-Map".
struct ForcedEffect {
    std::string name;
    bool on = true;
};

struct EffectWishes {
    EffectBase base = EffectBase::planned;
    std::vector<ForcedEffect> forced;
};

/// The plan with effects forced on and off on every draw, and their reasons updated.
///
/// \param plan  of this scene and these settings
/// \return a plan for Renderer. An effect forced on shows on every draw that can have it; the
///         reasons of the other draws explain why not
/// \throws InvalidInput if there is no effect of a name (near names are suggested), one name is
///         forced both ways, two effects exclude each other, or no draw at all can have an effect:
///         the message names effect, material and reason
FramePlan force_effects(const Scene& scene, const FrameSettings& settings, FramePlan plan,
                        const EffectWishes& wishes);

/// The effects that are on in any draw of a plan, and "skybox": those that can be forced off.
std::vector<std::string> effects_in(const FramePlan& plan);

}  // namespace relief
