// SPDX-License-Identifier: Apache-2.0
/// \file
/// Where things to click on are, for --dump-state: scripts and tests find a switch by its name.
/// Nothing is kept where nobody asks. Tests: tests/tools/window/window_test.cpp.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace relief::tools {

/// From now on places are kept.
void keep_places();

/// A frame begins: what was marked in the last one is forgotten.
void forget_places();

/// Call after an ImGui item: its middle is where `name` is, in the window's units, unless it is
/// scrolled out of sight.
void mark_place(const std::string& name);

/// {"Lights": [120, 240], ...}
nlohmann::ordered_json places_json();

}  // namespace relief::tools
