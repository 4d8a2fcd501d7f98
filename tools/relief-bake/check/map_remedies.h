// SPDX-License-Identifier: Apache-2.0
/// \file
/// What to do about what can be found in a normal map, as a command where relief can do it.
/// Tests: tests/tools/relief_bake_check_test.cpp runs each.
#pragma once

#include <filesystem>
#include <string>

#include "relief/mesh/normal_map_check.h"

namespace relief::tools {

/// Empty where there is no such command. Files to write are called "out.png".
std::string remedy_for(MapCondition condition, MapContent content,
                       const std::filesystem::path& file);

}  // namespace relief::tools
