// SPDX-License-Identifier: Apache-2.0
#include "common/findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/command.h"

namespace relief::tools {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

Report report_of(const std::string& kind) {
    Report report;
    report.add(kind, "triangle", 7, "has no say");
    return report;
}

TEST(Findings, SayWhereTheyAre) {
    Findings findings;
    EXPECT_TRUE(findings.empty());
    findings.add("", report_of("degenerate triangle"));
    findings.add("mesh 'Body' primitive 0", report_of("flipped triangle"));
    EXPECT_THAT(findings.lines(),
                ElementsAre(StartsWith("1 x degenerate triangle"),
                            StartsWith("mesh 'Body' primitive 0: 1 x flipped triangle")));
}

TEST(Findings, AreCutOffWithACountOfTheRest) {
    Findings findings;
    for (int i = 0; i < 20; ++i)
        findings.add("part " + std::to_string(i), report_of("degenerate triangle"));
    const std::vector<std::string> lines = findings.lines(12);
    ASSERT_EQ(lines.size(), 13U);
    EXPECT_EQ(lines.back(), "... and 8 more");
    EXPECT_EQ(findings.json().size(), 20U);
}

TEST(Findings, KeepEverythingInJson) {
    Findings findings;
    findings.add("part", report_of("degenerate triangle"));
    const nlohmann::ordered_json expected = {{{"where", "part"},
                                              {"kind", "degenerate triangle"},
                                              {"element", "triangle"},
                                              {"count", 1},
                                              {"first", {7}},
                                              {"outcome", "has no say"}}};
    EXPECT_EQ(findings.json(), nlohmann::ordered_json::array({expected[0]}));
}

}  // namespace
}  // namespace relief::tools
