// SPDX-License-Identifier: Apache-2.0
/// \file
/// The options of relief-view that contradict each other, need one another, or would have no
/// effect, in one table. Tests: tests/tools/relief_view_test.cpp.
#pragma once

#include "view_options.h"

namespace relief::tools {

/// \throws UsageError "OPTION: REASON (REMEDY)" for the first row of the table that applies
void check_conflicts(const ViewOptions& options);

}  // namespace relief::tools
