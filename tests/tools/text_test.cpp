// SPDX-License-Identifier: Apache-2.0
// Text of summaries and lists of findings.
#include "common/text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/command.h"

namespace relief::tools {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(SummaryText, CountsThings) {
    EXPECT_EQ(counted(1, "vertex", "vertices"), "1 vertex");
    EXPECT_EQ(counted(0, "vertex", "vertices"), "0 vertices");
    EXPECT_EQ(counted(3, "light"), "3 lights");
}

TEST(SummaryText, RoundsSizesToWhatMatters) {
    EXPECT_EQ(byte_size(999), "999 B");
    EXPECT_EQ(byte_size(1000), "1.0 kB");
    EXPECT_EQ(byte_size(12345), "12 kB");
    EXPECT_EQ(byte_size(999499), "999 kB");
    EXPECT_EQ(byte_size(999500), "1.0 MB");
    EXPECT_EQ(byte_size(8638012), "8.6 MB");
    EXPECT_EQ(byte_size(5000000000), "5.0 GB");
}

TEST(SummaryText, RoundsTimesToWhatMatters) {
    EXPECT_EQ(duration(0.04), "0.0 ms");
    EXPECT_EQ(duration(9.94), "9.9 ms");
    EXPECT_EQ(duration(9.96), "10 ms");
    EXPECT_EQ(duration(1234), "1.23 s");
    EXPECT_EQ(durations({{"read", 12}, {"write", 30}}), "read 12 ms, write 30 ms, 42 ms in all");
}

TEST(SummaryText, ExtensionsAreLowerCase) {
    EXPECT_EQ(extension_of("a/b.STL"), ".stl");
    EXPECT_EQ(extension_of("a.b/c"), "");
}

Report report_of(const std::string& kind) {
    Report report;
    report.add(kind, "triangle", 7, "does not contribute");
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
                                              {"outcome", "does not contribute"}}};
    EXPECT_EQ(findings.json(), nlohmann::ordered_json::array({expected[0]}));
}

}  // namespace
}  // namespace relief::tools
