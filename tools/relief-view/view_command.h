// SPDX-License-Identifier: Apache-2.0
/// \file
/// The command of relief-view. Tests: tests/tools/relief_view_test.cpp.
#pragma once

#include "common/command.h"

namespace relief::tools {

struct ViewOptions;

/// The tool for main(), and for tests that run it in their own process.
Tool relief_view();

/// Opens the window and returns when it is closed.
/// \param options  settled; without a model, the window waits for one to be dropped
/// \throws WindowError
ExitCode run_window(const ViewOptions& options);

Command add_view_command(CLI::App& tool);

}  // namespace relief::tools
