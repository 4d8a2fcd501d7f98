// SPDX-License-Identifier: Apache-2.0
// Runs every command that README.md, ARCHITECTURE.md, docs/*.md and conformance/*.md show, page by
// page, in a folder laid out like a built checkout; out/ there is its own. Scripts must exist and
// be executable, but are not run: they set up whole machines.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "docs/shown_commands.h"
#include "support/shared_data.h"
#include "tools/workplace.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

/// Pages relative to the sources, sorted.
std::vector<std::string> pages() {
    std::set<std::string> found;
    for (const char* folder : {".", "conformance", "docs"}) {
        if (!fs::is_directory(source_directory() / folder)) continue;
        for (const auto& entry : fs::directory_iterator(source_directory() / folder)) {
            if (entry.path().extension() == ".md")
                found.insert(entry.path().lexically_relative(source_directory()).string());
        }
    }
    return {found.begin(), found.end()};
}

class Document : public testing::TestWithParam<std::string> {};

TEST_P(Document, ShowsCommandsThatRun) {
    const Workplace workplace;
    for (const ShownCommand& command :
         shown_commands(contents_of(source_directory() / GetParam()))) {
        const std::string where = GetParam() + ":" + std::to_string(command.line);
        const std::string script = called_script(command.text);
        if (!script.empty()) {
            EXPECT_EQ(access((source_directory() / script).c_str(), X_OK), 0)
                << where << ": " << script << " is missing or not executable";
            continue;
        }
        const ProgramResult result = workplace.run(command.text);
        EXPECT_EQ(result.exit_code, 0) << where << ": " << command.text << "\n" << result.error;
    }
}

std::string test_name(const testing::TestParamInfo<std::string>& page) {
    std::string name;
    for (const char letter : page.param)
        name += std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
    return name;
}

INSTANTIATE_TEST_SUITE_P(All, Document, testing::ValuesIn(pages()), test_name);

}  // namespace
}  // namespace relief::test
