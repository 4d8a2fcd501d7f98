// SPDX-License-Identifier: Apache-2.0
// docs/normals.md says what is measured, not what once was.
#include "normal_errors/error_tables.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

namespace relief::test {
namespace {

TEST(NormalErrorTables, AreThoseOfThePage) {
    std::ifstream in(std::string(RELIEF_SOURCE_DIR) + "/docs/normals.md");
    ASSERT_TRUE(in);
    const std::string page{std::istreambuf_iterator<char>(in), {}};
    const std::size_t begin = page.find(tables_begin);
    ASSERT_NE(begin, std::string::npos);
    const std::size_t first = begin + std::string(tables_begin).size();
    EXPECT_EQ(page.substr(first, page.find(tables_end) - first), normal_error_tables() + "\n")
        << "run relief-normal-errors-page docs/normals.md";
}

}  // namespace
}  // namespace relief::test
