// SPDX-License-Identifier: Apache-2.0
/// \file
/// The commands of relief-accuracy. Each adds its options to the tool and says what to run.
#pragma once

#include "common/command.h"

namespace relief::tools {

/// The whole tool, for main() and for tests that run it in their own process.
Tool relief_accuracy();

Command add_run_command(CLI::App& tool);
Command add_own_command(CLI::App& tool);
Command add_report_compare_command(CLI::App& tool);
Command add_page_command(CLI::App& tool);

}  // namespace relief::tools
