// SPDX-License-Identifier: Apache-2.0
// relief-accuracy report as users run it: the page of a report that is there already.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "report_files.h"
#include "report_json.h"
#include "tools/refusal.h"
#include "tools/report_sample.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::sample_report;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

TEST(AccuracyReportCommand, MakesThePageThatTheRunMade) {
    const Workplace workplace;
    write_report(workplace / "made", sample_report());
    const std::string first = workplace.read("made/report.html");
    std::filesystem::remove(workplace / "made/report.html");
    const ProgramResult result = workplace.run("relief-accuracy report made/accuracy.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.error, "");
    EXPECT_THAT(result.out, HasSubstr("made/report.html: "));
    EXPECT_EQ(workplace.read("made/report.html"), first);
    const ProgramResult elsewhere =
        workplace.run("relief-accuracy report made/accuracy.json --output page.html --quiet");
    EXPECT_EQ(elsewhere.exit_code, 0) << elsewhere.error;
    EXPECT_EQ(elsewhere.out, "");
    EXPECT_EQ(workplace.read("page.html"), first);
}

TEST(AccuracyReportCommand, SaysWhereAReportHasNoPictures) {
    const Workplace workplace;
    workplace.write("printed.json", json_of(sample_report(), false).dump());
    const ProgramResult result = workplace.run("relief-accuracy report printed.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const std::string page = workplace.read("report.html");
    EXPECT_THAT(page, HasSubstr("<p class=\"absent\">Error map: Where, near: no picture was"));
    EXPECT_THAT(page, HasSubstr("<p class=\"absent\">Seen: truth: no picture was written</p>"));
    EXPECT_THAT(page, Not(HasSubstr("data:image/png")));
}

TEST(AccuracyReportCommand, LeavesFilesOutsideTheFolderAlone) {
    const Workplace workplace;
    write_report(workplace / "made", sample_report());
    json report = json::parse(workplace.read("made/accuracy.json"));
    for (const char* file : {"../secret.png", "/etc/passwd", "pictures/../../secret.png"}) {
        report["experiments"][0]["heat_maps"][0]["file"] = file;
        workplace.write("made/accuracy.json", report.dump());
        const ProgramResult result = workplace.run("relief-accuracy report made/accuracy.json");
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_EQ(result.error, std::string("relief-accuracy: error: made/accuracy.json: names the "
                                            "picture ") +
                                    file + ", which is outside its folder\n");
    }
}

TEST(AccuracyReportRefusal, IsOneLine) {
    const Workplace workplace;
    workplace.write("report.json", json_of(sample_report(), true).dump());
    workplace.write("words.json", "{\"format\": \"another\"}");
    expect_refusals(workplace, "relief-accuracy", "page.html",
                    {{"relief-accuracy report", 2, "REPORT is missing"},
                     {"relief-accuracy report none.json --output out/page.html", 1, "none.json: "},
                     {"relief-accuracy report words.json --output out/page.html", 1,
                      "words.json: /format: is 'another', not 'relief-accuracy'"},
                     {"relief-accuracy report report.json --output report.json", 2,
                      "report.json: would replace the report"},
                     {"relief-accuracy report report.json --output none/page.html", 1,
                      "none/page.html: the folder none does not exist"},
                     {"relief-accuracy report report.json --output out/page.html", 1,
                      "pictures/storage-sample-"}});
}

}  // namespace
}  // namespace relief::tools
