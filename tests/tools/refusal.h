// SPDX-License-Identifier: Apache-2.0
/// \file
/// What every refusal of a tool has in common: one line on stderr, nothing on stdout, no new file,
/// and the old output file as it was.
#pragma once

#include <string>
#include <vector>

#include "tools/workplace.h"

namespace relief::test {

/// A command line that must fail.
struct Refused {
    std::string line;  ///< With or without the tool's name.
    int exit_code;
    std::string error;  ///< A part of the line on stderr, after "TOOL: error: ".
};

/// Runs a line where out/ contains only `old_file`, with "old" in it.
void expect_refusal(const Workplace& workplace, const std::string& tool, const Refused& refused,
                    const std::string& old_file);
/// The same for each row of a table.
void expect_refusals(const Workplace& workplace, const std::string& tool,
                     const std::string& old_file, const std::vector<Refused>& rows);

}  // namespace relief::test
