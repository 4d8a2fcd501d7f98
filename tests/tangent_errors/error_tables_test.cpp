// SPDX-License-Identifier: Apache-2.0
// docs/tangents.md says what is measured, not what once was.
#include "tangent_errors/error_tables.h"

#include <gtest/gtest.h>

namespace relief::test {
namespace {

TEST(TangentErrorTables, AreThoseOfThePage) {
    const std::string page = contents_of_page(RELIEF_SOURCE_DIR "/docs/tangents.md");
    for (const PageSection& section : tangent_error_sections()) {
        EXPECT_EQ(section_in(page, section.begin), section.text)
            << "run relief-tangent-errors-page docs/tangents.md";
    }
}

}  // namespace
}  // namespace relief::test
