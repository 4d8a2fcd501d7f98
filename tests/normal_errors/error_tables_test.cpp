// SPDX-License-Identifier: Apache-2.0
// docs/normals.md says what is measured, not what once was.
#include "normal_errors/error_tables.h"

#include <gtest/gtest.h>

#include "support/error_page.h"

namespace relief::test {
namespace {

TEST(NormalErrorTables, AreThoseOfThePage) {
    const std::string page = contents_of_page(RELIEF_SOURCE_DIR "/docs/normals.md");
    EXPECT_EQ(section_in(page, tables_begin), normal_error_tables() + "\n")
        << "run relief-normal-errors-page docs/normals.md";
}

}  // namespace
}  // namespace relief::test
