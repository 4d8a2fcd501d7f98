// SPDX-License-Identifier: Apache-2.0
// docs/normals.md says what is measured, not what once was.
#include "normal_errors/error_tables.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>

#include "support/error_page.h"

namespace relief::test {
namespace {

TEST(NormalErrorTables, AreThoseOfThePage) {
    const std::string page = contents_of_page(RELIEF_SOURCE_DIR "/docs/normals.md");
    EXPECT_EQ(section_in(page, tables_begin), normal_error_tables() + "\n")
        << "run relief-normal-errors-page docs/normals.md";
}

TEST(ErrorPages, AreNotWrittenUnderTheNameOfAnOption) {
    for (const char* argument : {"--help", "-h", ""}) {
        const std::array<const char*, 2> arguments = {"relief-normal-errors-page", argument};
        EXPECT_EQ(write_sections(2, arguments.data(),
                                 []() -> std::vector<PageSection> {
                                     ADD_FAILURE() << "measures";
                                     return {};
                                 }),
                  2);
        EXPECT_FALSE(std::filesystem::exists(argument));
    }
}

}  // namespace
}  // namespace relief::test
