// SPDX-License-Identifier: Apache-2.0
/// \file
/// The explained pixels of a page (--page-probes). Tests: tests/tools/view_page/.
#pragma once

#include <vector>

#include "common/summary.h"
#include "pixel_probe.h"

namespace relief::tools {

/// Returns the pixels that a page explains: that of --probe, and the centers of a grid of
/// --page-probes cells.
std::vector<glm::ivec2> page_probe_places(const ViewOptions& options, const glm::ivec2& size);

/// Returns a pixel as pages show it: {"x", "y", "at", "vectors", "lobe", "text", "terms",
/// "radiance", "codes"}; "at" is the first visible point in world space, "vectors" are [label,
/// direction] there, and "lobe" is that of its first highlight, or null. Null if no surface is
/// visible.
Json page_probe_json(const ProbedPixel& pixel, const shade::Scene& scene);

}  // namespace relief::tools
