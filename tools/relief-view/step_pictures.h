// SPDX-License-Identifier: Apache-2.0
/// \file
/// The picture in steps: ambient light, then diffuse light, highlights, and so on (--steps).
/// Tests: tests/tools/steps_test.cpp.
#pragma once

#include <optional>
#include <vector>

#include "common/summary.h"
#include "picture_comparison.h"
#include "relief/shade/picture_steps.h"
#include "scene_options.h"
#include "view_options.h"

namespace relief::tools {

void add_step_options(CLI::App& app, ViewOptions& options);

/// A step that was drawn.
struct DrawnStep {
    shade::PictureStep step;
    std::optional<PictureComparison> change;  ///< From the step before.
};

/// Draws the steps, and writes them: numbered files if the name of the output has a #, else one
/// strip.
/// \throws FileError
std::vector<DrawnStep> draw_steps(const ViewOptions& options, const shade::FrameSettings& settings,
                                  const ComposedScene& composed, Stages& stages, Report& report);

/// Adds the member "steps": [{"name", "what", "effects", "parts", "change"}].
void add_steps(Summary& summary, const ViewOptions& options, const std::vector<DrawnStep>& steps);

}  // namespace relief::tools
