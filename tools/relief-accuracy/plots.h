// SPDX-License-Identifier: Apache-2.0
/// \file
/// Draws the plots of a report as SVG: the error of each method against its cost, and error curves.
///
/// Lengths are pixels, and colors are CSS classes of page/plot.css. Methods and curves have their
/// index as data-index, by which the script of the page shows and hides them.
/// Tests: tests/tools/accuracy_page/report_page_test.cpp, and report_page_test.py in a browser.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace relief::tools {

using Value = std::optional<double>;  ///< Nothing for a missing result.

/// Returns the finite number at a path, "/error/rms", if there is one.
Value number_at(const nlohmann::ordered_json& json, const std::string& path);

/// An entry of a legend; on the page it is also the check box that shows and hides its members.
struct LegendEntry {
    std::string name{};
    std::string remark{};
    std::size_t color = 0;  ///< Color and shape show the same, so that color is not essential.
    std::size_t shape = 0;
    bool has_mark = false;
    std::vector<std::size_t> members{};  ///< The indices of its methods or curves.
};

/// The entries of one choice of methods, or of all curves.
struct Legend {
    std::string name{};
    std::vector<LegendEntry> entries{};
};

/// A drawn plot.
struct Plot {
    std::string body{};   ///< The elements of the SVG.
    std::string label{};  ///< Describes the plot in words.
    std::vector<Legend> legends{};
};

/// Draws the methods of an experiment: RMS errors against the first cost that some method has.
/// \param tips  the text of each method's tooltip; empty: none
Plot scatter_plot(const nlohmann::ordered_json& experiment, const std::vector<std::string>& tips);

/// Draws the curves of a chart.
/// \param tips  the text of each point's tooltip, curve by curve; empty: none
Plot curves_plot(const nlohmann::ordered_json& chart, const std::vector<std::string>& tips);

/// Returns a plot for the page, with its legends as check boxes.
std::string plot_html(const Plot& plot);

/// Returns a plot as an SVG file with the style sheet, and the legend below the plot.
std::string svg_file(const Plot& plot);

/// An axis. Values without a position (0 on a logarithmic axis, missing results) have a strip at
/// one end.
struct Axis {
    bool is_log = true;
    std::string unit{};  ///< "seconds", "bytes" or empty.
    double low = 0.0;    ///< The value at `from`.
    double high = 0.0;   ///< The value at `to`.
    double from = 0.0, to = 0.0;
    bool has_zero = false, has_missing = false;
    double zero_at = 0.0, missing_at = 0.0;
    std::vector<double> ticks{};

    /// Returns the coordinate of a value.
    [[nodiscard]] double place(Value value) const;
};

/// Returns a horizontal axis for the range of these values, or a vertical one.
Axis x_axis(const std::vector<Value>& values, bool is_log, const std::string& unit);
Axis y_axis(const std::vector<Value>& errors);

/// Returns the ticks of a logarithmic axis: powers of 10, and their doubles and fivefolds where
/// space permits. Linear axes, and ranges with fewer than two powers, have ticks at round numbers.
/// \param room  the number of labels that fit
std::vector<double> ticks_of(double low, double high, bool is_log, double room);

/// Returns the label of a tick: "0.01", "10⁻⁵"; for the units "seconds" and "bytes" "10 µs", "2
/// kB".
std::string tick_text(double value, const std::string& unit);

}  // namespace relief::tools
