// SPDX-License-Identifier: Apache-2.0
// The form of every --help page. tests/docs/documents_test.cpp runs its examples.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "tools/help_pages.h"

namespace relief::tools {
namespace {

using test::ProgramResult;
using test::Workplace;
using testing::Contains;
using testing::StartsWith;

std::vector<std::string> lines_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

void expect_form(const std::string& command, const std::vector<std::string>& lines) {
    ASSERT_GT(lines.size(), 4U);
    EXPECT_TRUE(lines[0].ends_with('.')) << lines[0];
    EXPECT_EQ(lines[1], "");
    EXPECT_THAT(lines[2], StartsWith("Usage: " + command));
    const auto examples = std::find(lines.begin(), lines.end(), "Examples:");
    for (auto line = lines.begin(); line != examples; ++line)
        EXPECT_LE(line->size(), 100U) << *line;
}

/// The text of an option begins in column 30, on the same line or on the next.
void expect_described_options(const std::vector<std::string>& lines) {
    std::size_t options = 0;
    for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
        if (!lines[i].starts_with("  --")) continue;
        ++options;
        const std::string& text =
            lines[i].size() > 30 && lines[i][29] == ' ' ? lines[i] : lines[i + 1];
        EXPECT_TRUE(text.size() > 30 && text[29] == ' ' && text[30] != ' ') << lines[i];
    }
    EXPECT_GT(options, 0U);
}

TEST(HelpPage, IsOneSentenceThenUsageAndDescribesEveryOption) {
    const Workplace workplace;
    const std::vector<std::string> commands = test::commands_with_help(workplace);
    EXPECT_THAT(commands, Contains("relief-view"));
    EXPECT_THAT(commands, Contains("relief-bake convert"));
    EXPECT_GE(commands.size(), 20U);
    for (const std::string& command : commands) {
        SCOPED_TRACE(command);
        const ProgramResult result = workplace.run(command + " --help");
        EXPECT_EQ(result.exit_code, 0);
        EXPECT_EQ(result.error, "");
        expect_form(command, lines_of(result.out));
        expect_described_options(lines_of(result.out));
        const bool has_commands = result.out.find("\nCommands:\n") != std::string::npos;
        EXPECT_TRUE(has_commands || test::examples_of(result.out).size() >= 2U);
    }
}

}  // namespace
}  // namespace relief::tools
