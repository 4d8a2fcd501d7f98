// SPDX-License-Identifier: Apache-2.0
/// \file
/// Materials that animations move, in a page: their values at some times, between which the page
/// interpolates. Tests: tests/tools/view_page/.
#pragma once

#include <vector>

#include "relief/shade/effects.h"
#include "scene_options.h"
#include "view_options.h"

namespace relief::tools {

/// Returns the times at which the values of materials are recorded: the keys of their channels, and
/// three times between neighbors. Empty if no material moves, or there are more than 64.
std::vector<double> material_times(const shade::SceneGraph& graph);

/// Returns the scene at a time.
ComposedScene composed_at(const ComposedScene& composed, double seconds);

/// Adds the effects that the materials need at any of these times to the requests, so that the
/// programs are the same at all times. An effect that is forced on shows no difference.
void force_moving_effects(ViewOptions& options, const shade::FrameSettings& settings,
                          const ComposedScene& composed, const std::vector<double>& times);

}  // namespace relief::tools
