// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which lines of a Markdown page are commands of relief for the reader to type.
/// Tests: tests/docs/shown_commands_test.cpp.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
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

/// A page as it stands.
inline std::string contents_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// A script's path, where a command calls one; else empty.
std::string called_script(const std::string& command);

}  // namespace relief::test
