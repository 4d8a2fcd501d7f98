// SPDX-License-Identifier: Apache-2.0
/// \file
/// What every refusal of a tool has in common: one line on stderr, nothing on stdout, no new file,
/// and the old output file as it was.
#pragma once

#include <ostream>
#include <string>

#include "tools/workplace.h"

namespace relief::test {

/// A command line that must fail.
struct Refused {
    const char* line;
    int exit_code;
    const char* error;  ///< What the line on stderr holds, after "TOOL: error: ".
};

/// Names the test by its command line.
void PrintTo(const Refused& refused, std::ostream* stream);

/// Runs the line where out/ holds nothing but `old_file`, with "old" in it.
void expect_refusal(const Workplace& workplace, const std::string& tool, const Refused& refused,
                    const std::string& old_file);

}  // namespace relief::test
