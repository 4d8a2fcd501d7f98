// SPDX-License-Identifier: Apache-2.0
/// \file
/// Effects forced, priced and dropped by option, and the shaders to read.
///
///     --effects auto|all|none|+NAME,-NAME,...    also all,-NAME and none,+NAME
///
/// Tests: tests/tools/effect_options_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "relief/shade/effect_costs.h"
#include "relief/shade/shader_listing.h"
#include "view_options.h"

namespace relief::tools {

void add_effect_options(CLI::App& app, ViewOptions& options);

/// What --effects says. \throws UsageError if it is no list of that form
EffectWishes parse_effects(const std::string& subject, const std::string& text);

/// The scene's plan with the effects that were forced. \throws UsageError if they are unknown or
/// impossible here, naming effect, material and reason
FramePlan chosen_plan(const ViewOptions& options, const Scene& scene,
                      const FrameSettings& settings);

/// What was measured, as far as the options ask for it.
struct FrameMeasures {
    std::optional<FrameSeries> benchmark;
    std::optional<EffectCosts> costs;  ///< With --explain-effects.
    std::optional<BudgetedPlan> budget;
};

/// Drops effects from the plan for --budget, and then measures it. \throws FileError if the budget
/// cannot be kept, naming the model
FrameMeasures measure_frame(const ViewOptions& options, const MeasuredFrame& frame, FramePlan& plan,
                            Stages& stages);

/// Lines of the summary. \param drawn  with the plan that was measured
void print_measures(const FrameMeasures& measures, const ViewOptions& options, const Frame& drawn);

/// {"benchmark": {...}, "effect_costs": [...], "budget": {...}}, those that there are.
nlohmann::ordered_json measures_json(const FrameMeasures& measures, const ViewOptions& options,
                                     const Frame& drawn);

/// Prints each program's two shaders, as the driver gets them, under a comment that names its
/// effects and draws.
void print_shaders(const Scene& scene, const FramePlan& plan);

/// [{"effects", "draws", "files", "vertex", "fragment"}]
nlohmann::ordered_json shaders_json(const FramePlan& plan);

}  // namespace relief::tools
