// SPDX-License-Identifier: Apache-2.0
/// \file
/// A picture in steps, for teaching: ambient light, then diffuse light, highlights, shadows, maps,
/// reflection, Fresnel's factor, layers, emission and the tone curve, each added to what is there.
/// Pure. Tests: tests/shade/effects/picture_steps_test.cpp.
#pragma once

#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/shade/effects.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/scene.h"

namespace RELIEF_API relief {
namespace shade {

/// One step: everything of the steps before it, and these effects.
struct PictureStep {
    std::string name;  ///< "highlights"
    std::string what;  ///< "the mirror images of light sources"
    /// The effects that come with it, by name; those of the tone curve are of the whole frame.
    std::vector<std::string> effects;
    std::vector<std::string> parts;  ///< The parts of shaders that come with it; sorted.
    EffectRequest request;           ///< The effects of later steps, forced off.
    bool is_toned = false;           ///< The scene's exposure and tone curve are there.
};

/// Returns the steps of a picture. Steps that would not change the plan are left out. The plan of
/// the last step is that of plan_effects().
///
/// Surfaces of glTF's model scatter and mirror light sources by one formula: their diffuse light
/// and their highlights are one step. A scene without anything to add has one step, the picture.
///
/// \param settings  those of the picture; a linear picture has no tone curve
/// \throws GpuError if a file of `settings.shaders` or $RELIEF_SHADER_DIR includes a missing part
std::vector<PictureStep> picture_steps(const Scene& scene, const FrameSettings& settings);

/// Returns the scene of a step: without exposure and tone curve before they are there.
Scene scene_of_step(const Scene& scene, const PictureStep& step);

/// Returns the plan of a step. \param scene  scene_of_step()
FramePlan plan_of_step(const Scene& scene, const FrameSettings& settings, const PictureStep& step);

}  // namespace shade
}  // namespace relief
