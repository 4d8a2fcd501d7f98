// SPDX-License-Identifier: Apache-2.0
// Lists of files (@LIST and - for standard input), and reports on standard output (--report -).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "common/text.h"
#include "tools/refusal.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

class FileLists : public testing::Test {
  protected:
    FileLists() {
        place_.write_square("a.obj");
        place_.write_square("b c.obj");
    }

    const Workplace place_;
};

TEST_F(FileLists, NameOneFilePerLine) {
    place_.write("list.txt", "a.obj\r\n\nb c.obj");
    const ProgramResult result =
        place_.run("relief-mesh process @list.txt -o out/ --format glb --quiet");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(place_.outputs(), "a.glb b c.glb");
}

TEST_F(FileLists, MayComeFromStandardInput) {
    const ProgramResult lines = place_.run(
        "printf 'a.obj\\nb c.obj\\n' | relief-mesh process - -o out/ --format glb --quiet");
    EXPECT_EQ(lines.exit_code, 0) << lines.error;
    const ProgramResult zeros = place_.run(
        "printf 'a.obj\\0b c.obj\\0' | relief-mesh subdivide - -o out/ --format ply --quiet");
    EXPECT_EQ(zeros.exit_code, 0) << zeros.error;
    EXPECT_EQ(place_.outputs(), "a.glb a.ply b c.glb b c.ply");
}

TEST_F(FileLists, MayBeMixedWithNames) {
    place_.write("list.txt", "a.obj\n");
    const ProgramResult result = place_.run("relief-mesh check 'b c.obj' @list.txt --json");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    const json report = json::parse(result.out);
    ASSERT_EQ(report["files"].size(), 2U);
    EXPECT_EQ(report["files"][0]["file"], "b c.obj");
    EXPECT_EQ(report["files"][1]["file"], "a.obj");
}

TEST_F(FileLists, AreRefusedIfTheyListNothing) {
    place_.write("empty.txt", "\n\n");
    const ProgramResult empty = place_.run("relief-mesh process @empty.txt -o out/");
    EXPECT_EQ(empty.exit_code, 2);
    EXPECT_EQ(empty.first_error_line(),
              "relief-mesh: error: @empty.txt: lists no file (see relief-mesh process --help)");
    const ProgramResult input = place_.run("relief-mesh process - -o out/");
    EXPECT_EQ(input.exit_code, 2);
    EXPECT_THAT(input.error, HasSubstr("-: lists no file"));
    const ProgramResult missing = place_.run("relief-mesh process @none.txt -o out/");
    EXPECT_EQ(missing.exit_code, 1);
    EXPECT_THAT(missing.error, HasSubstr("relief-mesh: error: none.txt: "));
}

TEST_F(FileLists, ReportsOnStandardOutputReplaceTheSummary) {
    for (const std::string quiet : {"", " --quiet"}) {
        const ProgramResult one =
            place_.run("relief-mesh process a.obj out/a.glb --report -" + quiet);
        EXPECT_EQ(one.exit_code, 0) << one.error;
        EXPECT_EQ(json::parse(one.out)["output"], "out/a.glb");
    }
    const ProgramResult several =
        place_.run("relief-mesh process a.obj 'b c.obj' -o out/ --format glb --report -");
    EXPECT_EQ(json::parse(several.out)["files"].size(), 2U);
    // The next command in the same process prints its summary again.
    EXPECT_THAT(place_.run("relief-mesh process a.obj out/a.glb").out, HasSubstr("wrote     "));
    EXPECT_EQ(place_.outputs(), "a.glb b c.glb");
}

TEST(Findings, NameTexelsByColumnAndRow) {
    Report report;
    report.add("bent texel", "texel", 13, "is straightened");
    report.add("bent texel", "texel", 4, "is straightened");
    report.add("bent triangle", "triangle", 13, "is straightened");
    Findings findings;
    findings.add("map 1", report, 4);
    EXPECT_EQ(findings.lines()[0],
              "map 1: 2 x bent texel (column 0, row 1; column 1, row 3): is straightened");
    EXPECT_EQ(findings.lines()[1], "map 1: 1 x bent triangle (triangle 13): is straightened");
    const json list = findings.json();
    EXPECT_EQ(list[0]["texels"], json({{{"column", 0}, {"row", 1}}, {{"column", 1}, {"row", 3}}}));
    EXPECT_FALSE(list[1].contains("texels"));
}

}  // namespace
}  // namespace relief::tools
