// SPDX-License-Identifier: Apache-2.0
// Runs report_page_test.py, which tests the sample report in a browser.
#include <gtest/gtest.h>

#include <fstream>

#include "report_page.h"
#include "support/labels.h"
#include "tools/accuracy_page/sample_report.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

TEST_LABELS(slow, not_sanitized);
TEST(ReportPage, WorksInABrowser) {
    const test::TemporaryDirectory folder;
    std::ofstream(folder / "report.html")
        << report_html(sample_report(folder.path()), folder.path());
    const std::filesystem::path script =
        test::source_directory() / "tests/tools/accuracy_page/report_page_test.py";
    const test::ProgramResult result =
        test::run_line("python3 -B '" + script.string() + "' report.html", folder.path());
    constexpr int no_browser = 77;
    if (result.exit_code == no_browser) GTEST_SKIP() << result.error;
    EXPECT_EQ(result.exit_code, 0) << result.out << result.error;
}

}  // namespace
}  // namespace relief::tools
