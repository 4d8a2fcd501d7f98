// SPDX-License-Identifier: Apache-2.0
/// \file
/// The window from opening to closing. It draws when something changed, and otherwise sleeps.
/// Tests: tests/tools/window/window_test.cpp.
#pragma once

#include "common/command.h"
#include "view_options.h"

namespace relief::tools {

/// \param options  settled; without a model the window waits for one to be dropped
/// \throws WindowError
ExitCode run_window(const ViewOptions& options);

}  // namespace relief::tools
