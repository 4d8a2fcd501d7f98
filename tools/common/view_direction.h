// SPDX-License-Identifier: Apache-2.0
/// \file
/// Directions from a model to a camera or a light, as the options of all tools state them.
/// Tests: tests/tools/options_test.cpp, scene_options_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "common/options.h"

namespace relief::tools {

/// The unit vector of a direction.
///
/// \param azimuth  radians from +z towards +x
/// \param elevation  radians above the horizon
glm::vec3 towards(float azimuth, float elevation);

/// Parses "AZIMUTH,ELEVATION" in degrees. Returns a unit vector. \throws UsageError
glm::vec3 parse_view(const std::string& subject, const std::string& text);

/// The inverse of parse_view(), with six digits.
std::string view_text(const glm::vec3& direction);

/// Adds --view, which may be repeated: each adds a view to the measured ones.
AddedOption add_view_option(CLI::App& app, std::vector<glm::vec3>& views);

}  // namespace relief::tools
