// SPDX-License-Identifier: Apache-2.0
/// \file
/// What `relief-bake convert` says it did: a few lines for people, one of many files in one line,
/// or the --report file. Tests: tests/tools/convert_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "convert/convert_job.h"

namespace relief::tools {

void print_summary(const Job& job, const Converted& converted, const Stages& stages);

std::string line_of(const Job& job, const Converted& converted, const Stages& stages);

/// Without the names of the files.
nlohmann::ordered_json results_json(const Converted& converted, const Stages& stages);

}  // namespace relief::tools
