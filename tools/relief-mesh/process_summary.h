// SPDX-License-Identifier: Apache-2.0
/// \file
/// What `relief-mesh process` says it did: a few lines for people, or the --report file.
/// Tests: tests/tools/relief_mesh_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "common/command.h"
#include "processing.h"

namespace relief::tools {

void print_summary(const ProcessRequest& request, const Processed& done, const Stages& stages);

/// The same in one line, for one file of many.
std::string line_of(const ProcessRequest& request, const Processed& done, const Stages& stages);

/// What the --report file says: about one model, about what became of one of many, and about the
/// options.
nlohmann::ordered_json process_json(const ProcessRequest& request, const Processed& done,
                                    const Stages& stages);
nlohmann::ordered_json results_json(const Processed& done, const Stages& stages);
nlohmann::ordered_json options_json(const ProcessRequest& request);

/// The words of the command line.
std::string word_of(NormalMode mode);
std::string word_of(TangentMode mode);

}  // namespace relief::tools
