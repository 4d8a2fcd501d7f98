// SPDX-License-Identifier: Apache-2.0
/// \file
/// Maps that the command line puts on all materials: what to read, and how.
/// Tests: tests/tools/relief_view_test.cpp.
#pragma once

#include "view_options.h"

namespace relief::tools {

void add_map_options(CLI::App& app, ViewOptions& options);

/// \throws UsageError if one of them says nothing without another
void check_maps(const ViewOptions& options);

}  // namespace relief::tools
