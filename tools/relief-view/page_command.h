// SPDX-License-Identifier: Apache-2.0
/// \file
/// The output `relief-view MODEL --output page.html`. Tests: tests/tools/view_page/.
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "common/command.h"
#include "relief/mesh/report.h"
#include "relief/shade/effects.h"
#include "relief/shade/frame_settings.h"
#include "scene_options.h"
#include "view_options.h"

namespace relief::tools {

void add_page_options(CLI::App& app, ViewOptions& options);

/// Returns whether the output is a page.
bool is_page(const ViewOptions& options);

/// The counts and sizes of a written page.
struct WrittenPage {
    std::size_t bytes = 0;
    std::size_t programs = 0;
    std::size_t textures = 0;
    std::size_t pictures = 0;
    std::size_t steps = 0;
    std::size_t probes = 0;                      ///< Explained pixels.
    std::map<std::string, double> quantization;  ///< The errors of attributes, by name.
};

/// Reports a page above 100 MB, which browsers take long to open.
void report_size(std::size_t bytes, Report& report);

/// Records the scene and writes the page.
/// \param settings  of the picture that the command line draws
/// \throws InvalidInput for scenes that need more than WebGL 2 guarantees
WrittenPage write_page(const ViewOptions& given, const shade::FrameSettings& settings,
                       const ComposedScene& composed, Stages& stages, Report& report);

}  // namespace relief::tools
