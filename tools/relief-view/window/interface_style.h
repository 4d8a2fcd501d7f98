// SPDX-License-Identifier: Apache-2.0
/// \file
/// The font, the sizes and the colors of the panels.
/// Tests: tests/tools/window/panel_layout_test.cpp.
#pragma once

#include "window/window_system.h"

namespace relief::tools {

/// Sets font, sizes and colors of the current Dear ImGui context. Glyphs are rasterized in pixels;
/// other sizes are in window units. The texture of the font must be made again afterwards.
void apply_interface_style(const UiScale& scale, bool is_light);

}  // namespace relief::tools
