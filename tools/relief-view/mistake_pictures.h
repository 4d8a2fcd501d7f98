// SPDX-License-Identifier: Apache-2.0
/// \file
/// The gallery of mistakes: pictures with a mistake, and what it costs (--mistake).
/// Tests: tests/tools/mistakes_test.cpp, window/shader_edits_test.cpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/summary.h"
#include "picture_comparison.h"
#include "relief/shade/mistakes.h"
#include "scene_options.h"
#include "view_options.h"

namespace relief::tools {

void add_mistake_options(CLI::App& app, ViewOptions& options);

/// A mistake in a scene.
struct DrawnMistake {
    const shade::Mistake* mistake = nullptr;
    shade::MistakeReach reach;
    std::string_view vector;                  ///< The name of the measured direction; empty: none.
    std::optional<PictureComparison> change;  ///< From the right picture; none if it is hidden.
    std::optional<ErrorStats> angles;         ///< Of the measured direction.
    double changed_share = 0.0;               ///< Of the pixels, from 0 to 1.
};

/// Measures a mistake in a scene, whether it shows or not.
/// \param cost  gets the pictures, if somebody needs them; null. Its right picture, if it has one
///         of an earlier mistake, is not drawn again
/// \throws as mistake_cost() does
DrawnMistake measured_mistake(const shade::Mistake& mistake, const shade::Scene& scene,
                              const shade::Camera& camera, const shade::FrameSettings& settings,
                              const shade::Context& context, shade::RenderCache& cache,
                              Report& report = IgnoredReport(), shade::MistakeCost* cost = nullptr);

/// Draws the mistakes of the options, and writes the pictures if there is an output: the wrong
/// picture of one mistake; else a sheet, in which each row has the right picture, the wrong one and
/// their FLIP; or numbered files with wrong pictures if the name of the output has a #.
/// \throws UsageError if a mistake that was named cannot show in the scene; FileError
std::vector<DrawnMistake> draw_mistakes(const ViewOptions& options,
                                        const shade::FrameSettings& settings,
                                        const ComposedScene& composed, Stages& stages,
                                        Report& report);

/// For example "FLIP 0.0731 (largest 0.62), 21.3 % of the pixels change, normal off by 9.84 degrees
/// (99 %: 34.1, largest 36.9), on 1 of 4 surfaces", "changes no pixel that this camera sees, on 1
/// of 4 surfaces", or "does not show: no surface has ...".
std::string cost_text(const DrawnMistake& drawn);

/// Adds the member "mistakes": [{"name", "what", "shows", "reason", "surfaces", "of", "change",
/// "changed_share", "angles"}].
void add_mistakes(Summary& summary, const ViewOptions& options,
                  const std::vector<DrawnMistake>& drawn);

}  // namespace relief::tools
