// SPDX-License-Identifier: Apache-2.0
/// \file
/// Words, table and JSON of what was settled and measured. Tests:
/// tests/tools/bump_accuracy_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "bump/bump_accuracy.h"

namespace relief::tools {

/// "gaussian of radius 4 in float32, 16 bit"
std::string method_words(const BumpMethod& method);

/// "gaussian 4", or the plain name.
std::string kernel_words(const BumpMethod& method);

/// Lines of the summary: why the kernel, what keeps within the bound, the table of --compare.
void print_accuracy(const AccuracyFound& found);

/// Adds "kernel_reason", "destaircased_step", "reference", "chosen" and "comparison" to a report.
void add_accuracy(const AccuracyFound& found, nlohmann::ordered_json& report);

}  // namespace relief::tools
