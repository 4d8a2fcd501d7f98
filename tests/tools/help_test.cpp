// SPDX-License-Identifier: Apache-2.0
// Every --help page: its form, and that every example on it runs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "tools/workplace.h"

namespace relief::tools {
namespace {

using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;
using testing::StartsWith;

class HelpPage : public testing::TestWithParam<const char*> {};

std::vector<std::string> lines_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

/// The command lines below "Examples:".
std::vector<std::string> examples_of(const std::string& page) {
    std::vector<std::string> lines = lines_of(page);
    lines.erase(lines.begin(), std::find(lines.begin(), lines.end(), "Examples:"));
    std::vector<std::string> examples;
    for (const std::string& line : lines) {
        if (line.starts_with("  relief-")) examples.push_back(line.substr(2));
    }
    return examples;
}

TEST_P(HelpPage, IsOneSentenceThenUsageAndFitsTheScreen) {
    const Workplace workplace;
    const ProgramResult result = workplace.run(std::string(GetParam()) + " --help");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.error, "");
    const std::vector<std::string> lines = lines_of(result.out);
    ASSERT_GT(lines.size(), 4U);
    EXPECT_TRUE(lines[0].ends_with('.')) << lines[0];
    EXPECT_EQ(lines[1], "");
    EXPECT_THAT(lines[2], StartsWith(std::string("Usage: ") + GetParam()));
    const auto examples = std::find(lines.begin(), lines.end(), "Examples:");
    for (auto line = lines.begin(); line != examples; ++line)
        EXPECT_LE(line->size(), 100U) << *line;
}

TEST_P(HelpPage, NamesNoOptionWithoutSayingWhatItIsFor) {
    const Workplace workplace;
    const std::vector<std::string> lines =
        lines_of(workplace.run(std::string(GetParam()) + " --help").out);
    std::size_t options = 0;
    for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
        if (!lines[i].starts_with("  --")) continue;
        ++options;
        // The text stands in column 30, on the same line or the next.
        const std::string& text =
            lines[i].size() > 30 && lines[i][29] == ' ' ? lines[i] : lines[i + 1];
        EXPECT_TRUE(text.size() > 30 && text[29] == ' ' && text[30] != ' ') << lines[i];
    }
    EXPECT_GT(options, 0U);
}

TEST_P(HelpPage, ShowsExamplesThatRun) {
    const Workplace workplace;
    const std::string page = workplace.run(std::string(GetParam()) + " --help").out;
    if (page.find("Commands:") != std::string::npos) return;  // Its commands have the examples.
    const std::vector<std::string> examples = examples_of(page);
    EXPECT_GE(examples.size(), 2U);
    for (const std::string& example : examples) {
        const ProgramResult result = workplace.run(example);
        EXPECT_EQ(result.exit_code, 0) << example << "\n" << result.error;
        EXPECT_EQ(result.error, "") << example;
        EXPECT_NE(result.out, "") << example;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Tools, HelpPage,
    testing::Values("relief-accuracy", "relief-accuracy run", "relief-accuracy own",
                    "relief-accuracy compare", "relief-mesh", "relief-mesh process",
                    "relief-mesh info", "relief-mesh decimate", "relief-mesh subdivide",
                    "relief-mesh check", "relief-mesh compare", "relief-mesh conformance",
                    "relief-bake", "relief-bake bump", "relief-bake mesh", "relief-bake check",
                    "relief-bake heights", "relief-view"));

}  // namespace
}  // namespace relief::tools
