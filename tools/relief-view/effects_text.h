// SPDX-License-Identifier: Apache-2.0
/// \file
/// The effect plan in words: what is on, what is off, and why. Tests:
/// tests/tools/relief_view_test.cpp.
#pragma once

#include <nlohmann/json.hpp>

#include "relief/shade/effects.h"
#include "relief/shade/scene.h"

namespace relief::tools {

/// Prints the plan on stdout; draws with the same reasons share one table.
void print_effects(const Scene& scene, const FramePlan& plan);

/// {"frame": [{"effect", "on", "reason"}], "draws": [{"instance", "material", "triangles",
/// "tangents_computed", "effects": [...]}]}
nlohmann::ordered_json effects_json(const Scene& scene, const FramePlan& plan);

}  // namespace relief::tools
