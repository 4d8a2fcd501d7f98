// SPDX-License-Identifier: Apache-2.0
/// \file
/// The commands of relief-bake. Each adds its options to the tool and says what to run.
#pragma once

#include "common/command.h"

namespace relief::tools {

/// The whole tool, for main() and for tests that run it in their own process.
Tool relief_bake();

Command add_bump_command(CLI::App& tool);
Command add_map_check_command(CLI::App& tool);
Command add_heights_command(CLI::App& tool);
Command add_convert_command(CLI::App& tool);
Command add_mesh_command(CLI::App& tool);

}  // namespace relief::tools
