// SPDX-License-Identifier: Apache-2.0
/// \file
/// How --help pages look: one sentence, usage, arguments, grouped options with the text wrapped
/// beside the names, examples. Tests: tests/tools/command_test.cpp.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace relief::tools {

class HelpFormat : public CLI::FormatterBase {
  public:
    std::string make_help(const CLI::App* app, std::string name,
                          CLI::AppFormatMode mode) const override;
};

}  // namespace relief::tools
