// SPDX-License-Identifier: Apache-2.0
/// \file
/// Debug views and overlays by option.
///
///     --show VIEW --wireframe --vertex-frames [--frame-length R] --health-markers trouble|all
///
/// Tests: tests/tools/debug_options_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "relief/shade/effects.h"
#include "relief/shade/health_markers.h"
#include "view_options.h"

namespace relief::tools {

void add_debug_options(CLI::App& app, ViewOptions& options);

/// Refuses what could show nothing, and settles what a view of data is drawn with.
/// \throws UsageError
void check_debug_options(ViewOptions& options);

/// Markers of what the scene's meshes suffer from, where they are asked for.
HealthMarkers chosen_markers(const DebugChoices& choices, const Scene& scene);

/// \param markers  as chosen_markers() made them
Overlays overlays_of(const DebugChoices& choices, const HealthMarkers& markers);

/// The plan turned to the view that is asked for. \throws FileError, naming the model, where it has
/// nothing to show
FramePlan viewed_plan(const ViewOptions& options, const Scene& scene, const FrameSettings& settings,
                      FramePlan plan, Report& report);

/// What the markers' colours mean, a line each: "#ff0000: 3 collapsed triangles".
std::vector<std::string> legend(const HealthMarkers& markers);

/// [{"kind", "count", "marked", "color"}]
nlohmann::ordered_json legend_json(const HealthMarkers& markers);

/// {"wireframe", "vertex_frames", "health_markers": what legend_json() says, or null}
nlohmann::ordered_json overlays_json(const DebugChoices& choices, const HealthMarkers& markers);

/// The options that ask for the same, each with a space before it; "" for the plain picture.
std::string command_line_of(const DebugChoices& choices);

}  // namespace relief::tools
