// SPDX-License-Identifier: Apache-2.0
/// \file
/// Effects: forcing, measuring and dropping them by option, and printing the plan and the shaders.
///
///     --effects auto|all|none|+NAME,-NAME,...    also all,-NAME and none,+NAME
///
/// Tests: tests/tools/effect_options_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "relief/shade/effect_costs.h"
#include "relief/shade/effects.h"
#include "relief/shade/scene.h"
#include "view_options.h"

namespace relief::tools {

/// For example "'vase', material 'clay', 4096 triangles".
std::string draw_heading(const Scene& scene, const DrawPlan& draw);

/// Prints the plan on stdout. Draws with the same reasons share one table.
void print_effects(const Scene& scene, const FramePlan& plan);

/// {"frame": [{"effect", "on", "reason"}], "passes": [{"pass", "reason"}], "draws": [{"instance",
/// "material", "triangles", "tangents_computed", "effects": [...], "attributes": [{"name",
/// "stored", "reason"}], "textures": [{"sampler", "image", "mip_chain", "reason"}]}]}
nlohmann::ordered_json effects_json(const Scene& scene, const FramePlan& plan);

void add_effect_options(CLI::App& app, ViewOptions& options);

/// Parses the value of --effects.
/// \throws UsageError
EffectRequest parse_effects(const std::string& subject, const std::string& text);

/// The plan of the scene with forced effects.
/// \throws UsageError with effect, material and reason, if an effect is unknown or impossible in
///                 this scene
FramePlan chosen_plan(const ViewOptions& options, const Scene& scene,
                      const FrameSettings& settings);

/// The measurements that the options request.
struct FrameMeasures {
    std::optional<FrameSeries> benchmark;
    std::optional<EffectCosts> costs;  ///< Requested by --explain-effects.
    std::optional<BudgetedPlan> budget;
};

/// Drops effects from the plan for --budget, then measures the plan.
/// \throws FileError with the name of the model, if the budget is too small
FrameMeasures measure_frame(const ViewOptions& options, const MeasuredFrame& frame, FramePlan& plan,
                            Stages& stages);

/// Prints lines of the summary. \param drawn  a frame of the measured plan
void print_measures(const FrameMeasures& measures, const ViewOptions& options, const Frame& drawn);

/// {"benchmark": {...}, "effect_costs": {...}, "budget": {...}}, without measurements that were not
/// made.
nlohmann::ordered_json measures_json(const FrameMeasures& measures, const ViewOptions& options,
                                     const Frame& drawn);

/// Prints the vertex and fragment shader of each program, after a comment with its effects and
/// draws.
void print_shaders(const Scene& scene, const FramePlan& plan);

/// [{"effects", "draws", "files", "vertex", "fragment"}]
nlohmann::ordered_json shaders_json(const FramePlan& plan);

}  // namespace relief::tools
