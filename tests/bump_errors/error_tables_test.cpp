// SPDX-License-Identifier: Apache-2.0
// docs/bump.md says what is measured, not what once was.
#include "bump_errors/error_tables.h"

#include <gtest/gtest.h>

#include "support/error_page.h"

namespace relief::test {
namespace {

void expect_in_page(const char* begin, const std::string& tables) {
    const std::string page = contents_of_page(RELIEF_SOURCE_DIR "/docs/bump.md");
    EXPECT_EQ(section_in(page, begin), tables + "\n") << "run relief-bump-errors-page docs/bump.md";
}

TEST(BumpErrorTables, OfKernelsAreThoseOfThePage) {
    expect_in_page(kernels_begin, kernel_tables());
}

TEST(BumpErrorTables, OfChoicesAreThoseOfThePage) {
    expect_in_page(choices_begin, choice_tables());
}

TEST(BumpErrorTables, OfStepsAreThoseOfThePage) {
    expect_in_page(steps_begin, step_tables());
}

TEST(BumpErrorTables, OfDepthsAreThoseOfThePage) {
    expect_in_page(depths_begin, depth_tables());
}

}  // namespace
}  // namespace relief::test
