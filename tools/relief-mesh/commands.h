// SPDX-License-Identifier: Apache-2.0
/// \file
/// The commands of relief-mesh. Each adds its options to the tool and says what to run.
#pragma once

#include "common/command.h"

namespace relief::tools {

/// The whole tool, for main() and for tests that run it in their own process.
Tool relief_mesh();

Command add_process_command(CLI::App& tool);
Command add_info_command(CLI::App& tool);
Command add_check_command(CLI::App& tool);
Command add_compare_command(CLI::App& tool);
Command add_decimate_command(CLI::App& tool);
Command add_subdivide_command(CLI::App& tool);
Command add_conformance_command(CLI::App& tool);

}  // namespace relief::tools
