// SPDX-License-Identifier: Apache-2.0
/// \file
/// The option --probe X,Y: explains a pixel of the picture by the reference, and compares it with
/// the renderer's.
/// Tests: tests/tools/probe_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "probe_report.h"
#include "relief/shade/renderer.h"
#include "scene_options.h"
#include "view_options.h"

namespace relief::tools {

void add_probe_options(CLI::App& app, ViewOptions& options);

/// Refuses views without light. \throws UsageError
void check_probed_view(const ViewOptions& options);

/// Explains the pixel.
/// \param settings  those of the picture
/// \throws UsageError if the pixel is outside of the picture
ProbedPixel probed_pixel(const ViewOptions& options, const ComposedScene& composed,
                         const shade::FrameSettings& settings, Stages& stages, Report& report);

/// Explains several pixels of one picture, as probed_pixel() does.
/// \param places  columns and rows, inside of the picture
std::vector<ProbedPixel> probed_pixels(const ViewOptions& options, const ComposedScene& composed,
                                       const shade::FrameSettings& settings,
                                       const std::vector<glm::ivec2>& places, Stages& stages,
                                       Report& report);

}  // namespace relief::tools
