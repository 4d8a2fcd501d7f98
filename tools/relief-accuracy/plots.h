// SPDX-License-Identifier: Apache-2.0
/// \file
/// Draws the plots of a report as SVG: the error of each method against its cost, and error curves;
/// and their parts: marks, axes, ticks and legends. Lengths are pixels.
///
/// Colors are CSS classes of page/plot.css. On the page, methods and curves have their index as
/// data-index, by which the script shows and hides them.
/// Tests: tests/tools/accuracy_page/plots_test.cpp, and report_page_test.py in a browser.
#pragma once

#include <array>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace relief::tools {

/// Returns the <figure> of an experiment's methods for the page, with a legend.
/// \param tips  the text of each method's tooltip: a title, then lines of "name: value"
std::string scatter_figure(const nlohmann::ordered_json& experiment,
                           const std::vector<std::string>& tips);

/// Returns the plot and legend of a chart's curves for the page.
/// \param tips  the text of each point's tooltip, curve by curve
std::string chart_plot(const nlohmann::ordered_json& chart, const std::vector<std::string>& tips);

/// Returns the same plots as SVG files with a legend and the style sheet.
std::string scatter_picture(const nlohmann::ordered_json& experiment);
std::string chart_picture(const nlohmann::ordered_json& chart);

}  // namespace relief::tools

namespace relief::tools::plots {

using Value = std::optional<double>;  ///< Nothing for a missing result.

/// Returns the number at a path, "/error/rms", if there is one.
Value number_at(const nlohmann::ordered_json& json, const std::string& path);

/// Color and shape show the same choice, so that readers do not depend on color.
struct Look {
    std::size_t color = 0;
    std::size_t shape = 0;
};

constexpr std::size_t color_count = 10;  ///< The classes hue-0 to hue-9 of plot.css.

std::string mark(Look look);

/// Returns the class of a color: "hue-3".
std::string hue(std::size_t color);

/// Returns a coordinate with at most one decimal.
std::string px(double value);

/// Returns about the width of a text.
double text_width(const std::string& text);

/// The area within the axes.
struct Area {
    double left = 62.0;
    double right = 808.0;
    double top = 30.0;
    double bottom = 394.0;
};

/// An axis. Values without a place (0 on a logarithmic axis, missing results) have a strip at one
/// end.
struct Axis {
    bool is_log = true;
    std::string unit{};
    double low = 0.0;   ///< The value at `from`.
    double high = 0.0;  ///< The value at `to`.
    double from = 0.0, to = 0.0;
    bool has_zero = false, has_missing = false;
    double zero_at = 0.0, missing_at = 0.0;
    std::vector<double> ticks{};

    /// Returns the coordinate of a value.
    [[nodiscard]] double place(Value value) const;
};

/// Returns an axis for the range of these values.
Axis x_axis(const Area& area, const std::vector<Value>& values, bool is_log,
            const std::string& unit);

/// Returns an axis of errors, which is always logarithmic.
Axis y_axis(const Area& area, const std::vector<Value>& errors);

/// Returns the ticks of a logarithmic axis: powers of 10, and their doubles and fivefolds where
/// space permits. Linear axes, and ranges with fewer than two powers, have ticks at round numbers.
/// \param room  the number of labels that fit
std::vector<double> ticks_of(double low, double high, bool is_log, double room);

/// Returns the label of a tick: "0.01", "10⁻⁵"; for the units "seconds" and "bytes" "10 µs", "2
/// kB".
std::string tick_text(double value, const std::string& unit);

/// Returns the grid, ticks, strips and name of an axis.
/// \param missing  the label of the strip of missing values
std::string drawn_x_axis(const Area& area, const Axis& x, const std::string& name,
                         const std::string& missing);
std::string drawn_y_axis(const Area& area, const Axis& y, const std::string& name);

/// An entry of a legend; on the page it is also the check box that shows and hides it.
struct LegendEntry {
    std::string name{};
    std::optional<Look> look{};
    std::string remark{};
    std::vector<std::size_t> members{};  ///< The indices of its methods or curves.
};

/// The entries of one choice.
struct Legend {
    std::string name{};  ///< Empty: not shown.
    std::vector<LegendEntry> entries{};
};

/// A drawn plot.
struct Plot {
    std::string body{};   ///< The elements of the SVG.
    std::string label{};  ///< Describes the plot in words.
    std::vector<Legend> legends{};
};

/// Returns the plot for the page.
std::string page_svg(const Plot& plot);

/// Returns the entries as check boxes.
std::string legend_html(const Legend& legend);

/// Returns the plot as an SVG file with the style sheet, and the legend below the plot.
std::string svg_file(const Plot& plot);

/// Returns the start of a point that has a tooltip: its text, and an area to point at.
std::string tooltip(const std::string& text);

}  // namespace relief::tools::plots
