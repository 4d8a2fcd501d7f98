// SPDX-License-Identifier: Apache-2.0
/// \file
/// Effects forced on or off by name, against what the scene calls for. Pure: no OpenGL, no files.
///
/// An effect that is forced on where the scene gives it nothing to show is neutral: its numbers are
/// zero, its texture white, its lamps black, and the picture stays the same, bit for bit. Effects
/// for which that is not so are choices of the scene, and are refused: how a surface is lit at all
/// (unlit, metallic-roughness, Gouraud, flat), what its maps mean (object-space normal maps,
/// derivative frames, antialiasing of a real map), blending, the law of lamps that are there, exact
/// Fresnel of what is mirrored, tone curves, and whether the surroundings are seen or shed light.
/// Taking out whatever the scene calls for is always possible, and does change the picture.
/// Tests: tests/shade/effects/effect_forcing_test.cpp, tests/shade/render/forced_effects_test.cpp.
#pragma once

#include <string>
#include <vector>

#include "relief/shade/effects.h"

namespace relief {

/// What effects are set out from.
enum class EffectBase {
    planned,      ///< What the scene calls for.
    all_neutral,  ///< That, and on every draw each effect that changes no pixel there.
    nothing,      ///< No effect at all; those forced on are as the scene has them.
};

/// One effect by name (effects(), or a frame-wide one of FramePlan::reasons), letters in either
/// case, separators as one likes: "normal map", "Normal-Map".
struct ForcedEffect {
    std::string name;
    bool on = true;
};

struct EffectWishes {
    EffectBase base = EffectBase::planned;
    std::vector<ForcedEffect> forced;
};

/// The plan with effects put in and taken out on every draw, and the reasons put right.
///
/// \param plan  of this scene and these settings
/// \return a plan that Renderer takes. An effect forced on shows wherever it can; where a draw
///         cannot have it, that draw's reasons say why
/// \throws InvalidInput if there is no effect of a name (near names are suggested), one name is
///         forced both ways, two effects exclude each other, or no draw at all can have an effect:
///         the message names effect, material and reason
FramePlan force_effects(const Scene& scene, const FrameSettings& settings, FramePlan plan,
                        const EffectWishes& wishes);

/// The effects that are on in any draw of a plan, and "skybox": what can be taken out of it.
std::vector<std::string> effects_in(const FramePlan& plan);

}  // namespace relief
