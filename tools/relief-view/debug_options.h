// SPDX-License-Identifier: Apache-2.0
/// \file
/// Options for debug views and overlays.
///
///     --show VIEW --wireframe --vertex-frames [--frame-length R] --health-markers trouble|all
///
/// Tests: tests/tools/debug_options_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "relief/shade/effects.h"
#include "relief/shade/frame_settings.h"
#include "view_options.h"

namespace relief::tools {

void add_debug_options(CLI::App& app, ViewOptions& options);

/// Rejects options without an effect, and sets the options that data views need.
/// \throws UsageError
void check_debug_options(ViewOptions& options);

/// Finds the mesh problems that the options select.
HealthMarkers chosen_markers(const DebugChoices& choices, const Scene& scene);

/// \param markers  the result of chosen_markers()
Overlays overlays_of(const DebugChoices& choices, const HealthMarkers& markers);

/// Changes the plan to the selected debug view.
/// \throws FileError with the name of the model, if the view has nothing to show
FramePlan viewed_plan(const ViewOptions& options, const Scene& scene, const FrameSettings& settings,
                      FramePlan plan, Report& report);

/// Describes each marker color, for example "#ff0000 collapsed triangles: 3".
std::vector<std::string> legend(const HealthMarkers& markers);

/// [{"kind", "count", "marked", "color"}]
nlohmann::ordered_json legend_json(const HealthMarkers& markers);

/// {"wireframe", "vertex_frames", "health_markers": legend_json() or null}
nlohmann::ordered_json overlays_json(const DebugChoices& choices, const HealthMarkers& markers);

/// The options that select this view, each after a space; "" for the picture.
std::string command_line_of(const DebugChoices& choices);

}  // namespace relief::tools
