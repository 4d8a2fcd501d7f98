// SPDX-License-Identifier: Apache-2.0
/// \file
/// The one command of relief-view.
#pragma once

#include "common/command.h"

namespace relief::tools {

/// The whole tool, for main() and for tests that run it in their own process.
Tool relief_view();

Command add_view_command(CLI::App& tool);

}  // namespace relief::tools
