// SPDX-License-Identifier: Apache-2.0
/// \file
/// What `relief-bake bump` says it did: a few lines for people, one of many files in one line, or
/// the --report file. Tests: tests/tools/relief_bake_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bump/bump_job.h"

namespace relief::tools {

void print_summary(const Job& job, const BumpRequest& request, const Baked& baked,
                   const Stages& stages);

std::string line_of(const Job& job, const Baked& baked, const Stages& stages);

/// Without the names of the files.
nlohmann::ordered_json results_json(const Baked& baked, const Stages& stages);

}  // namespace relief::tools
