// SPDX-License-Identifier: Apache-2.0
/// \file
/// The commands of relief-mesh. Each function adds a command with its options to the tool.
#pragma once

#include "common/command.h"

namespace relief::tools {

Command add_process_command(CLI::App& tool);
Command add_decimate_command(CLI::App& tool);
Command add_lods_command(CLI::App& tool);
Command add_subdivide_command(CLI::App& tool);
Command add_displace_command(CLI::App& tool);
Command add_repair_command(CLI::App& tool);
Command add_remesh_command(CLI::App& tool);
Command add_unwrap_command(CLI::App& tool);
Command add_material_command(CLI::App& tool);
Command add_info_command(CLI::App& tool);
Command add_check_command(CLI::App& tool);
Command add_compare_command(CLI::App& tool);
Command add_conformance_command(CLI::App& tool);

/// The whole tool, for main() and for tests that run it in their own process.
inline Tool relief_mesh() {
    return {
        "relief-mesh",
        "Computes normals and tangents, reshapes, inspects and compares models, and stores maps.",
        {add_process_command, add_decimate_command, add_lods_command, add_subdivide_command,
         add_displace_command, add_repair_command, add_remesh_command, add_unwrap_command,
         add_material_command, add_info_command, add_check_command, add_compare_command,
         add_conformance_command}};
}

}  // namespace relief::tools
