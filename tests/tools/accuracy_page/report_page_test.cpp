// SPDX-License-Identifier: Apache-2.0
// The HTML page of a report: the text of its numbers, its plots as SVG and as files for documents,
// and the page without its script. report_page_test.py tests it in a browser.
#include "report_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <regex>

#include "common/html.h"
#include "plots.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "tools/accuracy_page/sample_report.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(HtmlText, EscapesMarkup) {
    EXPECT_EQ(html_escaped("a<b> & \"c\" 'd'"), "a&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39;");
}

TEST(HtmlText, NumbersHaveThreeDigits) {
    EXPECT_EQ(number_text(0.0), "0");
    EXPECT_EQ(number_text(0.012345), "0.0123");
    EXPECT_EQ(number_text(0.5), "0.500");
    EXPECT_EQ(number_text(9.996), "10.0");
    EXPECT_EQ(number_text(99.96), "100");
    EXPECT_EQ(number_text(-45.678), "-45.7");
    EXPECT_EQ(number_text(1234.5), "1230");
    EXPECT_EQ(number_text(0.00099999), "0.00100");
    EXPECT_EQ(number_text(0.00012345), "1.23e-04");
    EXPECT_EQ(number_text(1.5e7 + 0.5), "1.50e+07");
    EXPECT_EQ(number_text(8192.0), "8192") << "whole numbers stay whole";
    EXPECT_EQ(number_text({}), "–");
    EXPECT_EQ(number_text(NAN), "–");
}

TEST(HtmlText, RangesNameTheirUnitOnce) {
    EXPECT_EQ(range_text(0.00119, 0.00128), "1.19–1.28 ms");
    EXPECT_EQ(range_text(0.00099, 0.00102), "990 µs–1.02 ms");
}

TEST(HtmlText, BytesBelowAThousandAreNotRounded) {
    EXPECT_EQ(bytes_text(1.25), "1.25 B");
    EXPECT_EQ(bytes_text(4.0), "4 B");
    EXPECT_EQ(bytes_text(2000000.0), "2.0 MB");
    EXPECT_EQ(bytes_text({}), "–");
}

TEST(PlotTicks, LogarithmicAxesHaveOneTwoFive) {
    EXPECT_THAT(ticks_of(0.15, 12.0, true, 10.0), ElementsAre(0.2, 0.5, 1.0, 2.0, 5.0, 10.0));
    EXPECT_THAT(ticks_of(0.15, 1200.0, true, 6.0), ElementsAre(1.0, 10.0, 100.0, 1000.0))
        << "there is no space for more";
    EXPECT_THAT(ticks_of(1e-9, 1e9, true, 6.0), ElementsAre(1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9));
    EXPECT_THAT(ticks_of(2.2, 4.1, true, 8.0), ElementsAre(2.5, 3.0, 3.5, 4.0))
        << "one power or less has round numbers";
}

TEST(PlotTicks, LinearAxesHaveRoundNumbers) {
    EXPECT_THAT(ticks_of(-0.06, 1.06, false, 5.0), ElementsAre(0.0, 0.5, 1.0));
    EXPECT_THAT(ticks_of(0.0, 0.72, false, 8.0),
                ElementsAre(0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7));
}

TEST(PlotTicks, HaveUnitsOrPowersOfTen) {
    EXPECT_EQ(tick_text(0.0, ""), "0");
    EXPECT_EQ(tick_text(0.01, ""), "0.01");
    EXPECT_EQ(tick_text(-2.5, ""), "-2.5");
    EXPECT_EQ(tick_text(20000.0, ""), "20000");
    EXPECT_EQ(tick_text(1e-5, ""), "10⁻⁵");
    EXPECT_EQ(tick_text(5e12, ""), "5·10¹²");
    EXPECT_EQ(tick_text(2e-5, "seconds"), "20 µs");
    EXPECT_EQ(tick_text(1500.0, "seconds"), "1500 s");
    EXPECT_EQ(tick_text(1e-3, "seconds"), "1 ms");
    EXPECT_EQ(tick_text(2e-10, "seconds"), "0.2 ns");
    EXPECT_EQ(tick_text(2.5e6, "bytes"), "2.5 MB");
}

TEST(PlotAxis, UnplottableValuesHaveStrips) {
    const Axis plain = y_axis({0.01, 1.0});
    EXPECT_NEAR(plain.place(0.1), (plain.from + plain.to) / 2.0, 1e-9);
    EXPECT_GT(plain.place(0.01), plain.place(1.0)) << "errors grow upwards";
    EXPECT_FALSE(plain.has_zero);
    EXPECT_FALSE(plain.has_missing);
    const Axis strips = y_axis({0.01, 1.0, 0.0, {}, NAN});
    EXPECT_DOUBLE_EQ(strips.place(0.0), plain.from - 17.0);
    EXPECT_DOUBLE_EQ(strips.place({}), plain.to + 17.0);
    EXPECT_DOUBLE_EQ(strips.place(NAN), plain.to + 17.0);
    EXPECT_LT(strips.place(0.01), plain.from - 34.0);
    EXPECT_GT(strips.place(1.0), plain.to + 34.0);
}

TEST(PlotAxis, AllEqualValuesAreInTheMiddle) {
    EXPECT_NEAR(x_axis({3.0, 3.0}, true, "").place(3.0), 435.0, 1e-9);
    EXPECT_NEAR(x_axis({0.0}, false, "").place(0.0), 435.0, 1e-9);
}

class ReportHtml : public testing::Test {
  protected:
    test::TemporaryDirectory folder_;
    nlohmann::ordered_json report_ = sample_report(folder_.path());
    std::string page_ = report_html(report_, folder_.path());

    static std::size_t count_in(const std::string& text, const std::string& part) {
        std::size_t found = 0;
        for (std::size_t at = text.find(part); at != std::string::npos;
             at = text.find(part, at + 1))
            ++found;
        return found;
    }
    [[nodiscard]] std::size_t count(const std::string& part) const { return count_in(page_, part); }
};

TEST_F(ReportHtml, PlottedMethodsHaveStyleLegendAndFrontier) {
    const std::string svg = svg_file(scatter_plot(report_["experiments"][0], {}));
    EXPECT_THAT(svg, HasSubstr("<title>RMS error against time on one thread: 6 methods. "
                               "Efficient: area, float32; max, float32.</title>"));
    EXPECT_THAT(svg, HasSubstr("--hue: light-dark(#1668a8, #5aa9e6)"));
    EXPECT_EQ(count_in(svg, "<g class=\"point"), 6U);
    EXPECT_EQ(count_in(svg, "class=\"point partial"), 2U) << "methods with undefined results";
    EXPECT_EQ(count_in(svg, "<text class=\"point-label"), 2U);
    EXPECT_THAT(svg, HasSubstr("↑ RMS error, degrees"));
    EXPECT_EQ(count_in(svg, "<text class=\"legend"), 7U) << "5 weightings and 2 arithmetics";
    EXPECT_THAT(svg, Not(HasSubstr("class=\"reach\"")));
}

TEST_F(ReportHtml, PlottedCurvesHaveBoundsBreaksAndLegend) {
    const std::string svg = svg_file(curves_plot(report_["experiments"][0]["charts"][1], {}));
    EXPECT_THAT(svg, HasSubstr("<title>RMS error, degrees against scale: float32, breaks at 10⁻¹⁵; "
                               "exact.</title>"));
    EXPECT_EQ(count_in(svg, "<g class=\"point"), 8U);
    EXPECT_EQ(count_in(svg, "class=\"breaks\""), 1U);
    EXPECT_EQ(count_in(svg, "<text class=\"legend"), 2U);
    EXPECT_THAT(svg, HasSubstr(">bound 0.01</text>"));
}

TEST_F(ReportHtml, PlotsEscapeNames) {
    nlohmann::ordered_json experiment = report_["experiments"][1];
    experiment["measurements"][0]["method"] = "<8> & \"bit\"";
    experiment["error_unit"] = "<b>";
    const std::string svg = svg_file(scatter_plot(experiment, {}));
    EXPECT_THAT(svg, HasSubstr("&lt;8&gt; &amp; &quot;bit&quot;"));
    EXPECT_THAT(svg, Not(HasSubstr("<b>")));
    EXPECT_THAT(plot_html(scatter_plot(experiment, {"<tip>\nRMS: 1", "other"})),
                HasSubstr("<title>&lt;tip&gt;\nRMS: 1</title>"));
}

TEST_F(ReportHtml, IsSelfContained) {
    const std::regex loads(R"re((src|href)="([^"]*)")re");
    std::size_t pictures = 0;
    for (std::sregex_iterator match(page_.begin(), page_.end(), loads), end; match != end;
         ++match) {
        const std::string target = (*match)[2];
        pictures += target.starts_with("data:image/png;base64,") ? 1U : 0U;
        EXPECT_TRUE(target.starts_with("data:") || target.starts_with("#")) << target.substr(0, 80);
    }
    EXPECT_EQ(pictures, 3U);
    EXPECT_THAT(page_, Not(HasSubstr("url(")));
    EXPECT_THAT(page_, Not(HasSubstr("@import")));
    EXPECT_THAT(page_, HasSubstr("default-src 'none'"));
    EXPECT_THAT(page_, Not(HasSubstr("{{"))) << "a place of the template was not filled";
}

TEST_F(ReportHtml, NamesThatLookLikeMarkupStayText) {
    EXPECT_EQ(count("</script"), 1U) << "the end of the script, and no name's";
    EXPECT_EQ(count("<!--"), 1U) << "the template's own comment";
    EXPECT_THAT(page_, Not(HasSubstr("<b>")));
    EXPECT_THAT(page_, HasSubstr("<h3>&lt;/script&gt;&lt;!-- &lt;b&gt;Codes&lt;/b&gt;</h3>"));
    EXPECT_THAT(page_, HasSubstr("<dd>A &lt;b&gt;processor&lt;/b&gt;</dd>"));
}

TEST_F(ReportHtml, TablesCanBeReadWithoutAScript) {
    const auto has_row = [&](const std::string& cells) {
        const std::string plain =
            std::regex_replace(page_, std::regex(R"( data-value="[^"]*")"), "");
        EXPECT_THAT(plain, HasSubstr(cells));
    };
    has_row(
        "<td>0.123</td><td>0.0900</td><td>0.300</td><td>5</td><td>0</td>"
        "<td>2.00 ms <small>1.90–2.20 ms</small></td>"
        "<td>1.20 ms <small>1.10–1.30 ms</small></td><td>2.0 MB</td>");
    // Methods without an error have a time.
    has_row(
        "<td>–</td><td>–</td><td>–</td><td>–</td><td>100 (100 %)</td>"
        "<td>500 µs <small>500–600 µs</small></td>");
    EXPECT_THAT(page_, HasSubstr(R"(<td data-value="0.1234">0.123</td>)"));
    EXPECT_EQ(count(R"(<span class="efficient")"), 2U);
    EXPECT_THAT(page_, HasSubstr(R"(<small class="note">the fastest of those below a degree)"));
}

TEST_F(ReportHtml, CommonNotesAppearOnce) {
    for (nlohmann::ordered_json& one : report_["experiments"][2]["measurements"])
        one["note"] = "drawn by <llvmpipe>";
    page_ = report_html(report_, folder_.path());
    EXPECT_EQ(count("drawn by &lt;llvmpipe&gt;"), 1U);
    EXPECT_THAT(page_, HasSubstr(". drawn by &lt;llvmpipe&gt;</caption>"));
}

TEST_F(ReportHtml, UndefinedResultsHaveTheirFraction) {
    EXPECT_THAT(page_, HasSubstr(">undefined</th>"));
    EXPECT_THAT(page_, HasSubstr("0.0500</td><td data-value=\"2\">2 (2 %)</td>"));
}

TEST_F(ReportHtml, PicturesAreInTheBase64OfRfc4648) {
    for (const auto& [bytes, text] :
         {std::pair("", ""), std::pair("f", "Zg=="), std::pair("fo", "Zm8="),
          std::pair("foobar", "Zm9vYmFy"), std::pair("\xFF\xFE\xFB", "//77")}) {
        std::ofstream(folder_ / "pictures/heat.png") << bytes;
        EXPECT_THAT(report_html(report_, folder_.path()),
                    HasSubstr("<img src=\"data:image/png;base64," + std::string(text) + "\""));
    }
}

TEST_F(ReportHtml, SummaryHasFindingsOfMethodsAndInputs) {
    auto& own = report_["experiments"][1];
    own["finding"] = "xyz: 0.5 degrees RMS expected (the map itself 0.3, this method adds 0.4).";
    own["input_findings"] = {"2 x non-finite height (texel 5, 17): read as <0>"};
    own["measurements"][0]["expected_error"] = {{"map", 0.3}, {"added", 0.4}, {"total", 0.5}};
    page_ = report_html(report_, folder_.path());
    const std::string summary = page_.substr(0, page_.find("id=\"machine\""));
    EXPECT_THAT(summary, HasSubstr("expected (the map itself 0.3, this method adds 0.4)"));
    EXPECT_THAT(summary, HasSubstr("(texel 5, 17): read as &lt;0&gt;"));
    EXPECT_THAT(page_, HasSubstr(">expected</th>"));
    EXPECT_THAT(page_, HasSubstr("<td data-value=\"0.5\">0.500</td>"));
}

TEST_F(ReportHtml, OmitsEmptyColumns) {
    const std::size_t storage = page_.find("id=\"storage/sample\"");
    const std::string article = page_.substr(storage, page_.find("</article>", storage) - storage);
    EXPECT_THAT(article, HasSubstr(">stored</th>"));
    EXPECT_THAT(article, HasSubstr("<td data-value=\"1.25\">1.25 B</td>"));
    EXPECT_THAT(article, Not(HasSubstr("one thread")));
    EXPECT_THAT(article, Not(HasSubstr("PSNR")));
    EXPECT_THAT(article, Not(HasSubstr(">undefined</th>")));
    EXPECT_THAT(article, Not(HasSubstr(">expected</th>")));
    EXPECT_EQ(count(">PSNR, dB</th>"), 1U);
}

TEST_F(ReportHtml, ChartsHaveTheirNumbersAsTables) {
    EXPECT_THAT(page_, HasSubstr(R"(<th scope="row">slope, fitted</th><td>-2</td><td>-1</td>)"));
    EXPECT_THAT(page_, HasSubstr(R"(<th scope="row">breaks at</th><td>1.00e-15</td><td>–</td>)"));
    EXPECT_THAT(page_, HasSubstr(R"(<th scope="row">1.00e-20</th><td>no result</td><td>0</td>)"));
}

TEST_F(ReportHtml, LinksLeadToExperiments) {
    EXPECT_THAT(page_, HasSubstr(R"(<a href="#normals/sample">A torus</a>)"));
    EXPECT_THAT(page_, HasSubstr(R"(<article id="normals/sample">)"));
}

TEST_F(ReportHtml, AMissingPictureIsNamed) {
    std::filesystem::remove(folder_ / "pictures/after.png");
    EXPECT_THAT(test::message_of<FileError>([&] { report_html(report_, folder_.path()); }),
                HasSubstr("pictures/after.png"));
}

TEST_F(ReportHtml, AReportWithoutExperimentsIsAPage) {
    report_["experiments"] = nlohmann::ordered_json::array();
    EXPECT_THAT(report_html(report_, folder_.path()), HasSubstr("<h1>Accuracy report</h1>"));
}

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
