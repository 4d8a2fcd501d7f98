// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the command line says about debug views: --show, --wireframe, --vertex-frames,
/// --frame-length, --health-markers. Tests: tests/tools/debug_options_test.cpp.
#pragma once

#include <optional>

#include "relief/shade/debug_views.h"

namespace relief::tools {

/// What of the health check is marked.
enum class HealthChoice { trouble, all };

struct DebugChoices {
    DebugView view = DebugView::picture;
    bool wireframe = false;
    bool vertex_frames = false;
    std::optional<float> frame_length;  ///< As a share of the scene's size.
    std::optional<HealthChoice> health_markers;
};

}  // namespace relief::tools
