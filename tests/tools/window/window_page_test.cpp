// SPDX-License-Identifier: Apache-2.0
// docs/window.md shows every panel that there is, with a picture that exists and is small.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

#include "support/shared_data.h"
#include "tools/window/display.h"
#include "window/panels.h"

namespace relief::tools {
namespace {

std::string page() {
    return test::contents_of(test::source_directory() / "docs/window.md");
}

/// What stands below a panel's heading, up to the next one.
std::string section_of(const std::string& panel) {
    const std::string text = page();
    const std::size_t begin = text.find("\n### " + panel + "\n");
    if (begin == std::string::npos) return "";
    return text.substr(begin, text.find("\n#", begin + 1) - begin);
}

TEST(WindowPage, ShowsEveryPanel) {
    ASSERT_FALSE(panel_names().empty());
    for (const std::string& panel : panel_names())
        EXPECT_THAT(section_of(panel), testing::HasSubstr("](images/window-")) << panel;
}

TEST(WindowPage, ItsPicturesExistAndAreSmall) {
    const std::string text = page();
    const std::regex picture(R"(\]\((images/[^)]*)\))");
    int count = 0;
    for (std::sregex_iterator match(text.begin(), text.end(), picture), end; match != end;
         ++match, ++count) {
        const std::filesystem::path file = test::source_directory() / "docs" / (*match)[1].str();
        ASSERT_TRUE(std::filesystem::exists(file)) << file;
        EXPECT_LT(std::filesystem::file_size(file), 150'000U) << file;
    }
    EXPECT_GT(count, 8);
}

TEST(WindowPage, ItsPicturesAreAllMadeByTheScript) {
    const std::string script =
        test::contents_of(test::source_directory() / "scripts/window-pictures");
    const std::string text = page();
    const std::regex picture(R"(images/([^)]*)\.png)");
    for (std::sregex_iterator match(text.begin(), text.end(), picture), end; match != end; ++match)
        EXPECT_THAT(script, testing::HasSubstr("\"" + (*match)[1].str() + "\""));
}

}  // namespace
}  // namespace relief::tools
