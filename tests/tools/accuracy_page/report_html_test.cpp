// SPDX-License-Identifier: Apache-2.0
// The HTML page of a report without its script, and the text of its numbers.
#include "report_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <regex>

#include "common/html.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
#include "tools/accuracy_page/sample_report.h"

namespace relief::tools {
namespace {

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

class ReportHtml : public testing::Test {
  protected:
    test::TemporaryDirectory folder_;
    nlohmann::ordered_json report_ = sample_report(folder_.path());
    std::string page_ = report_html(report_, folder_.path());

    [[nodiscard]] std::size_t count(const std::string& text) const {
        std::size_t found = 0;
        for (std::size_t at = page_.find(text); at != std::string::npos;
             at = page_.find(text, at + 1))
            ++found;
        return found;
    }
};

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

}  // namespace
}  // namespace relief::tools
