// SPDX-License-Identifier: Apache-2.0
/// \file
/// The effect plan in words: what is on, what is off, and why. Tests:
/// tests/tools/relief_view_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "relief/shade/effects.h"
#include "relief/shade/scene.h"

namespace relief::tools {

/// "'vase', material 'clay', 4096 triangles"
std::string draw_heading(const Scene& scene, const DrawPlan& draw);

/// Prints the plan on stdout; draws with the same reasons share one table.
void print_effects(const Scene& scene, const FramePlan& plan);

/// {"frame": [{"effect", "on", "reason"}], "passes": [{"pass", "reason"}], "draws": [{"instance",
/// "material", "triangles", "tangents_computed", "effects": [...], "attributes": [{"name",
/// "stored", "reason"}], "textures": [{"sampler", "image", "mip_chain", "reason"}]}]}
nlohmann::ordered_json effects_json(const Scene& scene, const FramePlan& plan);

}  // namespace relief::tools
