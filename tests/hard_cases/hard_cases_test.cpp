// SPDX-License-Identifier: Apache-2.0
// Every row of the catalogue, and that the page in the documents says what the table does.
#include "hard_cases/hard_case.h"

#include <gtest/gtest.h>

#include <cctype>
#include <fstream>
#include <iterator>
#include <set>

#include "hard_cases/page.h"
#include "relief/mesh/diagnose.h"
#include "support/shared_data.h"

namespace relief::test {
namespace {

class HardCases : public testing::TestWithParam<HardCase> {};

TEST_P(HardCases, HaveTheirOutcome) {
    ASSERT_FALSE(GetParam().expectations.empty());
    for (const Expectation& expectation : GetParam().expectations)
        EXPECT_EQ(expectation.problem(), "") << expectation.step << ": " << expectation.outcome;
}

std::string test_name(const testing::TestParamInfo<HardCase>& row) {
    std::string name;
    for (const char letter : row.param.name)
        name += std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
    return name + "_" + std::to_string(row.index);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, HardCases, testing::ValuesIn(hard_cases()), test_name);

TEST(HardCasesTable, NamesEachRowOnceAndSaysWhereItIsKnownFrom) {
    std::set<std::string> names;
    for (const HardCase& row : hard_cases()) {
        EXPECT_TRUE(names.insert(row.name).second) << row.name;
        EXPECT_FALSE(row.what.empty()) << row.name;
        EXPECT_FALSE(row.source.empty()) << row.name;
    }
}

TEST(HardCasesTable, HasARowForEveryWordOfCheck) {
    std::string all;
    for (const HardCase& row : hard_cases()) {
        for (const Expectation& expectation : row.expectations) {
            if (expectation.step == "check") all += expectation.outcome + ",";
        }
    }
    for (const MeshConditionInfo& condition : mesh_conditions())
        EXPECT_NE(all.find("x " + std::string(condition.word) + ","), std::string::npos)
            << condition.word;
}

TEST(HardCasesPage, SaysWhatTheTableDoes) {
    std::ifstream file(source_directory() / "docs/hard-cases.md", std::ios::binary);
    const std::string page{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    EXPECT_EQ(page, hard_cases_page())
        << "write it anew: build/release/bin/relief-hard-cases-page docs/hard-cases.md";
}

}  // namespace
}  // namespace relief::test
