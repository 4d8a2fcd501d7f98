// SPDX-License-Identifier: Apache-2.0
// Draws the error of methods against their cost: a mark per method, and the line of efficient
// methods. Tests: tests/tools/accuracy_page/plots_test.cpp, and report_page_test.py in a browser.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "plots.h"
#include "relief/accuracy/experiment.h"
#include "report_page.h"

namespace relief::tools {
using namespace relief::accuracy;

using namespace plots;
using nlohmann::ordered_json;

namespace {

/// A cost that can be the axis of a plot.
struct CostAxis {
    const char* name;
    const char* unit;
    const char* path;  ///< The path of its value in a measurement; empty: the order of the table.
};

constexpr std::array<CostAxis, 4> all_costs = {
    {{"time on one thread", "seconds", "/cost/one_thread/median"},
     {"time on all threads", "seconds", "/cost/all_threads/median"},
     {"peak memory", "bytes", "/cost/peak_bytes"},
     {"stored size", "bytes", "/cost/stored_bytes"}}};
constexpr CostAxis no_cost = {"order of the table (no times)", "", ""};

/// Returns the first cost that some method has.
CostAxis cost_axis(const ordered_json& measurements) {
    for (const CostAxis& cost : all_costs) {
        if (std::any_of(measurements.begin(), measurements.end(), [&](const ordered_json& one) {
                return number_at(one, cost.path).value_or(0.0) > 0.0;
            }))
            return cost;
    }
    return no_cost;
}

std::string choice_of(const ordered_json& measurement, const std::string& name) {
    const auto choices = measurement.find("choices");
    return choices == measurement.end() ? "–" : choices->value(name, "–");
}

/// Returns the choices with more than one value.
std::vector<Legend> varying_choices(const ordered_json& measurements) {
    std::vector<Legend> choices;
    for (const ordered_json& one : measurements) {
        const ordered_json all = one.value("choices", ordered_json::object());
        for (const auto& [name, value] : all.items()) {
            if (std::none_of(choices.begin(), choices.end(),
                             [&name = name](const Legend& known) { return known.name == name; }))
                choices.push_back({name, {}});
        }
    }
    for (Legend& choice : choices) {
        for (std::size_t i = 0; i < measurements.size(); ++i) {
            const std::string value = choice_of(measurements[i], choice.name);
            auto entry = std::find_if(choice.entries.begin(), choice.entries.end(),
                                      [&](const LegendEntry& one) { return one.name == value; });
            if (entry == choice.entries.end())
                entry = choice.entries.insert(entry, {.name = value});
            entry->members.push_back(i);
        }
    }
    std::erase_if(choices, [](const Legend& choice) { return choice.entries.size() < 2; });
    // Colors show the first choice and shapes the second, or both the only one.
    for (std::size_t c = 0; c < std::min<std::size_t>(choices.size(), 2); ++c) {
        for (std::size_t i = 0; i < choices[c].entries.size(); ++i) {
            const Look look = choices.size() == 1 ? Look{i, i}
                              : c == 0            ? Look{i, 0}
                                                  : Look{color_count - 1, i};
            choices[c].entries[i].look = look;
        }
    }
    return choices;
}

Look look_of(const std::vector<Legend>& choices, std::size_t index) {
    if (choices.empty()) return {index, index};
    const auto place = [&](const Legend& choice) {
        const auto entry =
            std::find_if(choice.entries.begin(), choice.entries.end(), [&](const LegendEntry& one) {
                return std::find(one.members.begin(), one.members.end(), index) !=
                       one.members.end();
            });
        return static_cast<std::size_t>(entry - choice.entries.begin());
    };
    return {place(choices[0]), place(choices[std::min<std::size_t>(1, choices.size() - 1)])};
}

Value cost_of(const ordered_json& measurement, std::size_t index, const CostAxis& cost) {
    const std::string path = cost.path;
    if (path.empty()) return static_cast<double>(index);
    const Value value = number_at(measurement, path);
    // A stored size of 0 is not a size.
    return path == all_costs[3].path && value == 0.0 ? std::nullopt : value;
}

/// Returns the range of the middle 80 % of the rounds, or nothing without times.
std::optional<std::pair<double, double>> range_of(const ordered_json& measurement,
                                                  const CostAxis& cost) {
    if (std::string_view(cost.unit) != "seconds") return std::nullopt;
    const std::string times = std::filesystem::path(cost.path).parent_path().string();
    const Value p10 = number_at(measurement, times + "/p10");
    const Value p90 = number_at(measurement, times + "/p90");
    if (!p10 || !p90) return std::nullopt;
    return std::pair{*p10, *p90};
}

/// The methods of an experiment with their positions.
struct Scatter {
    CostAxis cost{};
    Axis x_axis{};
    Axis y_axis{};
    std::vector<double> x{};
    std::vector<double> y{};
    std::vector<std::size_t> efficient{};  ///< By increasing cost.

    [[nodiscard]] bool is_efficient(std::size_t index) const {
        return std::find(efficient.begin(), efficient.end(), index) != efficient.end();
    }
};

bool has_undefined(const ordered_json& measurement) {
    return number_at(measurement, "/error/undefined").value_or(0.0) > 0.0;
}

/// Returns whether each method is efficient: by the times as the report says, else by the cost.
std::vector<bool> efficient_of(const ordered_json& measurements, const CostAxis& cost) {
    std::vector<MethodCost> costs;
    std::vector<bool> reported;
    for (std::size_t i = 0; i < measurements.size(); ++i) {
        const ordered_json& one = measurements[i];
        const bool is_known = cost.path[0] != '\0' && !has_undefined(one);
        costs.push_back({is_known ? number_at(one, "/error/rms").value_or(NAN) : NAN,
                         cost_of(one, i, cost).value_or(NAN)});
        reported.push_back(one.value("efficient", false));
    }
    return std::string_view(cost.unit) == "seconds" ? reported : pareto_optimal(costs);
}

Scatter scatter_of(const ordered_json& measurements, const Area& area) {
    Scatter scatter{.cost = cost_axis(measurements)};
    std::vector<Value> along, errors;
    for (std::size_t i = 0; i < measurements.size(); ++i) {
        along.push_back(cost_of(measurements[i], i, scatter.cost));
        errors.push_back(number_at(measurements[i], "/error/rms"));
    }
    std::vector<Value> all = along;
    for (const ordered_json& one : measurements) {
        if (const auto range = range_of(one, scatter.cost))
            all.insert(all.end(), {range->first, range->second});
    }
    const bool has_cost = scatter.cost.path[0] != '\0';
    scatter.x_axis = x_axis(area, all, has_cost, scatter.cost.unit);
    if (!has_cost) scatter.x_axis.ticks.clear();
    scatter.y_axis = y_axis(area, errors);
    const std::vector<bool> is_efficient = efficient_of(measurements, scatter.cost);
    for (std::size_t i = 0; i < measurements.size(); ++i) {
        scatter.x.push_back(scatter.x_axis.place(along[i]));
        scatter.y.push_back(scatter.y_axis.place(errors[i]));
        if (is_efficient[i]) scatter.efficient.push_back(i);
    }
    std::stable_sort(
        scatter.efficient.begin(), scatter.efficient.end(), [&](std::size_t a, std::size_t b) {
            return std::pair(scatter.x[a], -scatter.y[a]) < std::pair(scatter.x[b], -scatter.y[b]);
        });
    return scatter;
}

/// The position of a label relative to its point.
struct LabelPlace {
    double dx, dy;
    const char* anchor;
};
constexpr std::array<LabelPlace, 4> label_places = {
    {{9.0, -7.0, "start"}, {9.0, 15.0, "start"}, {-9.0, 15.0, "end"}, {-9.0, -7.0, "end"}}};

struct Box {
    double left, right, top, bottom;
};

/// Returns the labels of the efficient methods, where they have space: they overlap neither each
/// other nor points.
std::vector<std::string> labels_of(const Scatter& scatter, const ordered_json& measurements,
                                   const Area& area) {
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < scatter.x.size(); ++i)
        boxes.push_back(
            {scatter.x[i] - 5.0, scatter.x[i] + 5.0, scatter.y[i] - 5.0, scatter.y[i] + 5.0});
    std::vector<std::string> labels(scatter.x.size());
    for (const std::size_t i : scatter.efficient) {
        const std::string method = measurements[i].value("method", "");
        const double width = text_width(method);
        for (const auto& [dx, dy, anchor] : label_places) {
            const double left = scatter.x[i] + dx - (dx < 0.0 ? width : 0.0);
            const Box box = {left, left + width, scatter.y[i] + dy - 10.0, scatter.y[i] + dy + 3.0};
            const bool is_free = box.left >= area.left && box.right <= area.right &&
                                 box.top >= area.top && box.bottom <= area.bottom &&
                                 std::none_of(boxes.begin(), boxes.end(), [&](const Box& other) {
                                     return box.left < other.right && other.left < box.right &&
                                            box.top < other.bottom && other.top < box.bottom;
                                 });
            if (!is_free) continue;
            boxes.push_back(box);
            labels[i] = fmt::format(
                "<text class=\"point-label\" x=\"{}\" y=\"{}\" text-anchor=\"{}\" "
                "aria-hidden=\"true\">{}</text>",
                px(dx), px(dy), anchor, html_escaped(method));
            break;
        }
    }
    return labels;
}

/// Returns the efficient methods as a step line.
std::string frontier(const Scatter& scatter, const Area& area) {
    std::string path;
    for (const std::size_t i : scatter.efficient)
        path += path.empty()
                    ? fmt::format("M{},{}V{}", px(scatter.x[i]), px(area.top), px(scatter.y[i]))
                    : fmt::format("H{}V{}", px(scatter.x[i]), px(scatter.y[i]));
    if (!path.empty()) path += "H" + px(area.right);
    return fmt::format("<path class=\"frontier\" d=\"{}\"/>\n", path);
}

/// Returns the bar of a method's times.
std::string whisker(const Scatter& scatter, const ordered_json& measurement, std::size_t index,
                    std::size_t color) {
    const auto range = range_of(measurement, scatter.cost);
    if (!range) return "";
    const double at = scatter.x[index];
    return fmt::format(R"(<line class="whisker {}" x1="{}" x2="{}"/>)", hue(color),
                       px(scatter.x_axis.place(range->first) - at),
                       px(scatter.x_axis.place(range->second) - at));
}

/// \param tips  the text of each method's tooltip; empty for a picture in a document
Plot scatter_plot(const ordered_json& experiment, const std::vector<std::string>& tips) {
    const ordered_json& measurements = experiment.at("measurements");
    const Area area;
    const Scatter scatter = scatter_of(measurements, area);
    const std::vector<std::string> labels = labels_of(scatter, measurements, area);
    Plot plot;
    plot.legends = varying_choices(measurements);
    plot.body = fmt::format(
        "<g aria-hidden=\"true\">{}{}</g>\n{}",
        drawn_x_axis(area, scatter.x_axis, scatter.cost.name, "not timed"),
        drawn_y_axis(area, scatter.y_axis, "RMS error, " + experiment.value("error_unit", "")),
        frontier(scatter, area));
    std::vector<std::size_t> order(measurements.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return scatter.x[a] < scatter.x[b]; });
    for (const std::size_t i : order) {
        const Look look = look_of(plot.legends, i);
        plot.body += fmt::format(
            "<g class=\"point{}{}\" data-index=\"{}\" "
            "transform=\"translate({},{})\">{}{}{}{}</g>\n",
            has_undefined(measurements[i]) ? " partial" : "",
            scatter.is_efficient(i) ? " efficient" : "", i, px(scatter.x[i]), px(scatter.y[i]),
            tips.empty() ? "" : tooltip(tips[i]), whisker(scatter, measurements[i], i, look.color),
            mark(look), labels[i]);
    }
    std::vector<std::string> names;
    for (const std::size_t i : scatter.efficient)
        names.push_back(measurements[i].value("method", ""));
    plot.label =
        fmt::format("RMS error against {}: {} methods.", scatter.cost.name, measurements.size());
    if (!names.empty()) plot.label += fmt::format(" Efficient: {}.", fmt::join(names, "; "));
    return plot;
}

}  // namespace

std::string scatter_figure(const ordered_json& experiment, const std::vector<std::string>& tips) {
    const Plot plot = scatter_plot(experiment, tips);
    std::string html =
        "<figure class=\"scatter\"><figcaption><h4>Error against cost</h4></figcaption>\n" +
        page_svg(plot);
    for (const Legend& legend : plot.legends)
        html += legend_html(legend);
    return html + "</figure>\n";
}

std::string scatter_picture(const ordered_json& experiment) {
    return svg_file(scatter_plot(experiment, {}));
}

}  // namespace relief::tools
