// SPDX-License-Identifier: Apache-2.0
/// \file
/// The commands of relief-accuracy. Each function adds a command with its options to the tool.
#pragma once

#include "common/command.h"

namespace relief::tools {

Command add_run_command(CLI::App& tool);
Command add_own_command(CLI::App& tool);
Command add_report_compare_command(CLI::App& tool);
Command add_page_command(CLI::App& tool);

/// The whole tool, for main() and for tests that run it in their own process.
inline Tool relief_accuracy() {
    return {"relief-accuracy",
            "Measures the error and the time of methods, and compares reports.",
            {add_run_command, add_own_command, add_report_compare_command, add_page_command}};
}

}  // namespace relief::tools
