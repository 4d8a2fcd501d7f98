// SPDX-License-Identifier: Apache-2.0
/// \file
/// An experiment as text for a terminal: a table with the frontier marked, in units for people.
/// Tests: tests/tools/accuracy_report_test.cpp.
#pragma once

#include <string>

#include "relief/accuracy/experiment.h"
#include "relief/accuracy/words.h"

namespace relief::tools {

/// What the experiment asks and on what, a row for each method, their notes, a line for each curve,
/// and the finding. The rows on the frontier begin with an asterisk; columns that nothing fills are
/// left out.
std::string table_of(const Experiment& experiment);

}  // namespace relief::tools
