// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which lines of a Markdown page are commands of relief for the reader to type.
/// Tests: tests/docs/shown_commands_test.cpp.
#pragma once

#include <string>
#include <vector>

namespace relief::test {

struct ShownCommand {
    int line = 0;  ///< In the page, from 1.
    std::string text;
};

/// Lines that begin with "$ ", and lines in blocks marked console, sh, shell or bash, where they
/// call one of the tools ("relief-...", "build/release/bin/relief-...") or a script
/// ("scripts/..."). A backslash at the end of a line continues it. Everything else is left alone.
std::vector<ShownCommand> shown_commands(const std::string& page);

/// A script's path, where a command calls one; else empty.
std::string called_script(const std::string& command);

}  // namespace relief::test
