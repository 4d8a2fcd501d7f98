// SPDX-License-Identifier: Apache-2.0
// Plots as SVG: ticks, positions on axes, legends, and the files for documents.
#include "plots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tools/accuracy_page/sample_report.h"

namespace relief::tools {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

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

class PlotFiles : public testing::Test {
  protected:
    test::TemporaryDirectory folder_;
    nlohmann::ordered_json report_ = sample_report(folder_.path());

    static std::size_t count(const std::string& text, const std::string& part) {
        std::size_t found = 0;
        for (std::size_t at = text.find(part); at != std::string::npos;
             at = text.find(part, at + 1))
            ++found;
        return found;
    }
};

TEST_F(PlotFiles, MethodsHaveStyleLegendAndFrontier) {
    const std::string svg = svg_file(scatter_plot(report_["experiments"][0], {}));
    EXPECT_THAT(svg, HasSubstr("<title>RMS error against time on one thread: 6 methods. "
                               "Efficient: area, float32; max, float32.</title>"));
    EXPECT_THAT(svg, HasSubstr("--hue: light-dark(#1668a8, #5aa9e6)"));
    EXPECT_EQ(count(svg, "<g class=\"point"), 6U);
    EXPECT_EQ(count(svg, "class=\"point partial"), 2U) << "methods with undefined results";
    EXPECT_EQ(count(svg, "<text class=\"point-label"), 2U);
    EXPECT_THAT(svg, HasSubstr("↑ RMS error, degrees"));
    EXPECT_EQ(count(svg, "<text class=\"legend"), 7U) << "5 weightings and 2 arithmetics";
    EXPECT_THAT(svg, Not(HasSubstr("class=\"reach\"")));
}

TEST_F(PlotFiles, CurvesHaveBoundsBreaksAndLegend) {
    const std::string svg = svg_file(curves_plot(report_["experiments"][0]["charts"][1], {}));
    EXPECT_THAT(svg, HasSubstr("<title>RMS error, degrees against scale: float32, breaks at 10⁻¹⁵; "
                               "exact.</title>"));
    EXPECT_EQ(count(svg, "<g class=\"point"), 8U);
    EXPECT_EQ(count(svg, "class=\"breaks\""), 1U);
    EXPECT_EQ(count(svg, "<text class=\"legend"), 2U);
    EXPECT_THAT(svg, HasSubstr(">bound 0.01</text>"));
}

TEST_F(PlotFiles, EscapeNames) {
    nlohmann::ordered_json experiment = report_["experiments"][1];
    experiment["measurements"][0]["method"] = "<8> & \"bit\"";
    experiment["error_unit"] = "<b>";
    const std::string svg = svg_file(scatter_plot(experiment, {}));
    EXPECT_THAT(svg, HasSubstr("&lt;8&gt; &amp; &quot;bit&quot;"));
    EXPECT_THAT(svg, Not(HasSubstr("<b>")));
    EXPECT_THAT(plot_html(scatter_plot(experiment, {"<tip>\nRMS: 1", "other"})),
                HasSubstr("<title>&lt;tip&gt;\nRMS: 1</title>"));
}

}  // namespace
}  // namespace relief::tools
