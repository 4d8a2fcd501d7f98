// SPDX-License-Identifier: Apache-2.0
/// \file
/// The effects and the debug views of a picture, by option.
///
///     --effects auto|all|none|+NAME,-NAME,...    also all,-NAME and none,+NAME
///     --show VIEW --wireframe --vertex-frames [--frame-length R] --health-markers problems|all
///
/// Tests: tests/tools/effect_options_test.cpp, debug_options_test.cpp.
#pragma once

#include <string>
#include <vector>

#include "common/summary.h"
#include "relief/shade/effect_costs.h"
#include "relief/shade/effects.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/scene.h"
#include "view_options.h"

namespace relief::tools {

// Effects: forcing, measuring and dropping them, and printing the plan and the shaders.

/// For example "'vase', material 'clay', 4096 triangles".
std::string draw_heading(const shade::Scene& scene, const shade::DrawPlan& draw);

/// The plan with its reasons. As text, draws with the same reasons share a list.
Summary effect_summary(const shade::Scene& scene, const shade::FramePlan& plan);

void add_effect_options(CLI::App& app, ViewOptions& options);

/// Parses the value of --effects.
/// \throws UsageError
shade::EffectRequest parse_effects(const std::string& subject, const std::string& text);

/// The plan of the scene with forced effects.
/// \throws UsageError with effect, material and reason, if an effect is unknown or impossible in
///                 this scene
shade::FramePlan chosen_plan(const ViewOptions& options, const shade::Scene& scene,
                             const shade::FrameSettings& settings);

/// The measurements that the options request.
struct FrameMeasures {
    std::optional<shade::FrameSeries> benchmark;
    std::optional<shade::EffectCosts> costs;  ///< Requested by --explain-effects.
    std::optional<shade::BudgetedPlan> budget;
};

/// Drops effects from the plan for --budget, then measures the plan.
/// \throws FileError with the name of the model, if the budget is too small
FrameMeasures measure_frame(const ViewOptions& options, const shade::MeasuredFrame& frame,
                            shade::FramePlan& plan, Stages& stages);

/// Adds the members "benchmark", "effect_costs" and "budget", if they were measured.
/// \param drawn  a frame of the measured plan
void add_measures(Summary& summary, const FrameMeasures& measures, const ViewOptions& options,
                  const shade::Frame& drawn);

/// Prints the vertex and fragment shader of each program, after a comment with its effects and
/// draws.
void print_shaders(const shade::Scene& scene, const shade::FramePlan& plan);

/// [{"effects", "draws", "files", "vertex", "fragment"}]
Json shaders_json(const shade::FramePlan& plan);

// Debug views and overlays.

void add_debug_options(CLI::App& app, ViewOptions& options);

/// Rejects options without an effect, and sets the options that data views need.
/// \throws UsageError
void check_debug_options(ViewOptions& options);

/// Finds the mesh problems that the options select.
shade::HealthMarkers chosen_markers(const DebugChoices& choices, const shade::Scene& scene);

/// \param markers  the result of chosen_markers()
shade::Overlays overlays_of(const DebugChoices& choices, const shade::HealthMarkers& markers,
                            const shade::Grid& grid);

/// Changes the plan to the selected debug view.
/// \throws FileError with the name of the model, if the view has nothing to show
shade::FramePlan viewed_plan(const ViewOptions& options, const shade::Scene& scene,
                             const shade::FrameSettings& settings, shade::FramePlan plan,
                             Report& report);

/// Describes each marker color, for example "#ff0000 collapsed triangles: 3".
void add_legend(Summary& summary, const shade::HealthMarkers& markers);

/// [{"kind", "count", "marked", "color"}]
Json legend_json(const shade::HealthMarkers& markers);

/// {"wireframe", "vertex_frames", "grid", "health_markers": legend_json() or null}
Json overlays_json(const DebugChoices& choices, const shade::HealthMarkers& markers);

/// The options that select this view, each after a space; "" for the picture.
std::string command_line_of(const DebugChoices& choices);

}  // namespace relief::tools
