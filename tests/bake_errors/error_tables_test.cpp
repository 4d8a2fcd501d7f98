// SPDX-License-Identifier: Apache-2.0
// docs/bake.md says what is measured, not what once was.
#include "bake_errors/error_tables.h"

#include <gtest/gtest.h>

namespace relief::test {
namespace {

TEST(BakeErrorTables, AreThoseOfThePage) {
    const std::string page = contents_of_page(RELIEF_SOURCE_DIR "/docs/bake.md");
    for (const PageSection& section : bake_tables()) {
        EXPECT_EQ(section_in(page, section.begin), section.text)
            << "run relief-bake-errors-page docs/bake.md";
    }
}

}  // namespace
}  // namespace relief::test
