// SPDX-License-Identifier: Apache-2.0
/// \file
/// The commands of relief-accuracy. Each adds its options to the tool and says what to run.
#pragma once

#include "common/command.h"

namespace relief::tools {

Command add_run_command(CLI::App& tool);
Command add_own_command(CLI::App& tool);
Command add_report_compare_command(CLI::App& tool);
Command add_page_command(CLI::App& tool);

}  // namespace relief::tools
