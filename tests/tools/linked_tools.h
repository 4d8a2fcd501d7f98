// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tools that run_line() calls in the test's own process. Only one of the project's tools with
/// plain arguments runs there, in a tenth of the time of a process; a line that needs a shell
/// (pipes, redirections, variables, several commands) runs in one. Test programs get the tools by
/// linking relief_linked_tools.
#pragma once

#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/workplace.h"

namespace relief::test {

/// Runs a line as run_line() does, but always in a shell.
ProgramResult run_shell(const std::string& line, const std::filesystem::path& folder);

/// A tool's entry point: arguments without the program's name, where to print results and messages.
/// \return the exit code
using ToolEntry =
    std::function<int(const std::vector<std::string>& arguments, std::FILE* out, std::FILE* err)>;

/// Makes run_line() call this entry point for the tool of this name. \return true
bool link_tool(const std::string& name, const ToolEntry& entry);

/// The words of a line that a shell would pass to a program unchanged except for quotes; none if
/// the line has anything else in it that a shell interprets.
std::optional<std::vector<std::string>> plain_text(const std::string& line);

}  // namespace relief::test
