// SPDX-License-Identifier: Apache-2.0
// docs/normal-maps.md says what is measured, not what once was.
#include "normal_map_errors/error_tables.h"

#include <gtest/gtest.h>

namespace relief::test {
namespace {

TEST(NormalMapErrorTables, AreThoseOfThePage) {
    const std::string page = contents_of_page(RELIEF_SOURCE_DIR "/docs/normal-maps.md");
    for (const PageSection& section : normal_map_tables()) {
        EXPECT_EQ(section_in(page, section.begin), section.text)
            << "run relief-normal-map-errors-page docs/normal-maps.md";
    }
}

}  // namespace
}  // namespace relief::test
