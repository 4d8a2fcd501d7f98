// SPDX-License-Identifier: Apache-2.0
/// \file
/// The streams that the running tool prints to: standard output and standard error, unless a caller
/// of run_...() passed others.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "common/command.h"

namespace relief::tools {

/// Where results go.
std::FILE* out();

/// Where errors, warnings and progress go.
std::FILE* err();

/// Whether err() is a terminal, so that progress is shown.
bool is_err_terminal();

/// Parses the arguments, runs the tool and reports errors. Only one tool runs at a time in a
/// process.
///
/// \param arguments  without the program's name
/// \param out  where results are printed
/// \param err  where errors, warnings and progress are printed
/// \return the exit code for the process
int run_tool(const Tool& tool, const std::vector<std::string>& arguments, std::FILE* out,
             std::FILE* err);

}  // namespace relief::tools
