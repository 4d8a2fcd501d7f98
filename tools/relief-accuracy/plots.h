// SPDX-License-Identifier: Apache-2.0
/// \file
/// Draws the plots of a report as SVG: the error of each method against its cost, and error curves.
///
/// Colors are CSS classes of page/plot.css. On the page, a plot of costs has a group for each axis
/// choice, and points have their positions for all choices as attributes; the script shows, hides
/// and moves them. A picture for a document shows only the first choice.
/// Tests: tests/tools/accuracy_page/plots_test.cpp, and report_page_test.py in a browser.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace relief::tools {

/// Returns the <figure> of an experiment's methods for the page, with switches and a legend.
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
