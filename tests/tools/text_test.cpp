// SPDX-License-Identifier: Apache-2.0
// Summaries as text and JSON, and lists of findings.
#include "common/summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
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

TEST(SummaryText, RoundsSizes) {
    EXPECT_EQ(byte_size(999), "999 B");
    EXPECT_EQ(byte_size(1000), "1.0 kB");
    EXPECT_EQ(byte_size(12345), "12 kB");
    EXPECT_EQ(byte_size(999499), "999 kB");
    EXPECT_EQ(byte_size(999500), "1.0 MB");
    EXPECT_EQ(byte_size(8638012), "8.6 MB");
    EXPECT_EQ(byte_size(5000000000), "5.0 GB");
}

TEST(SummaryText, RoundsTimes) {
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

TEST(SummaryText, EscapesControlCharactersAndInvalidUtf8) {
    const std::string kept = "a\xC2\xA0\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80~";
    EXPECT_EQ(printable(kept), kept);
    EXPECT_EQ(printable("a\x1B[2J\n\x7F"), "a\\x1b[2J\\x0a\\x7f");
    // U+009B begins commands of terminals, as ESC [ does.
    EXPECT_EQ(printable("\xC2\x9B\x32J\xC2\x80"), "\\xc2\\x9b2J\\xc2\\x80");
    EXPECT_EQ(printable("b\xE4r"), "b\\xe4r") << "Latin-1";
    EXPECT_EQ(printable("\xC2"), "\\xc2");
    EXPECT_EQ(printable_lines("a\x07\nb\n\nc\x9B\n"), "a\\x07\nb\n\nc\\x9b\n");
    EXPECT_EQ(printable_lines(""), "");
}

TEST(Summary, RendersTextAndJsonFromOneList) {
    Summary part;
    part.add("error", "2 degrees", {{"degrees", 2}});
    Summary summary;
    summary.add("read", Summary::Lines{"a.obj: 3 triangles", "b.obj: 4 triangles"},
                {{"triangles", {3, 4}}});
    summary.add("omitted", "", {{"omitted", 0}});
    summary.add_part("check", part);
    summary.add_lines(part);
    summary.add_json({{"complete", true}});
    testing::internal::CaptureStdout();
    summary.print();
    std::fflush(stdout);
    EXPECT_EQ(testing::internal::GetCapturedStdout(),
              "read      a.obj: 3 triangles\n          b.obj: 4 triangles\n"
              "error     2 degrees\nerror     2 degrees\n");
    EXPECT_EQ(summary.json().dump(),
              R"({"triangles":[3,4],"omitted":0,"check":{"degrees":2},"complete":true})");
}

Report report_of(const std::string& kind) {
    Report report;
    report.add(kind, "triangle", 7, "does not contribute");
    return report;
}

TEST(Findings, NameTheirFile) {
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
