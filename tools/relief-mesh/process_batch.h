// SPDX-License-Identifier: Apache-2.0
/// \file
/// Processing many models in one call: one that fails does not stop the others.
/// Tests: tests/tools/process_batch_test.cpp.
#pragma once

#include <vector>

#include "common/command.h"
#include "common/options.h"
#include "common/report_options.h"
#include "processing.h"

namespace relief::tools {

/// Processes every request. As each is done, in the order given, a line on stdout says what became
/// of it, or an error on stderr; then the report is written.
///
/// Several models are worked on at once, as many as there are threads; one after another where they
/// could write the same file beside theirs, which .gltf's images may be.
///
/// \return failed if any failed; else fell_back if --strict was given and anything was found
ExitCode process_all(const CLI::App& app, const std::vector<ProcessRequest>& requests,
                     const ReportOptions& report, const GeneralOptions& general);

}  // namespace relief::tools
